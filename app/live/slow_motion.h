// SPDX-License-Identifier: Apache-2.0
// Pictures between two steps. In slow motion a step lasts many pictures, and robots would move in jerks.
//
//   wall time  ---|--------|--------|--------|---->
//   snapshots     A        B        C
//   pictures               . . . . . . . . .        on the lines from A to B and from B to C
//
// A picture shows the state one step and 35 ms ago, so that the snapshots before and after it are known.
#pragma once

#include <deque>
#include <memory>
#include <span>
#include <vector>

#include "app/live/snapshot.h"

namespace mercury {

// While physics pauses or makes more than `most_rate` steps per second, shows the newest snapshot as it is.
class SlowMotion {
 public:
  static constexpr double most_rate = 250;    // steps per second of wall time, up to which pictures are interpolated
  static constexpr double allowance = 0.035;  // time to compute, publish and fetch a step [s]

  // Adds the newest snapshot.
  void take(std::shared_ptr<const Snapshot> snapshot);

  struct Shown {
    double time = 0;                  // simulated [s]
    std::span<const Vec3> positions;  // on the host; empty if they are on the GPU
    const PositionSnapshot* device = nullptr;
    std::span<const Telemetry> telemetry;  // of the newest snapshot, with interpolated centers of mass
  };
  // The picture at a wall time [s]. The spans are valid until the next call of either member.
  Shown at(double wall);

 private:
  double wanted(double wall) const;

  std::deque<std::shared_ptr<const Snapshot>> snapshots_;  // of the same robots, oldest first
  double shown_ = 0;                                       // time of the last picture; it never goes back
  std::vector<Vec3> positions_;
  std::vector<Telemetry> telemetry_;
};

}  // namespace mercury
