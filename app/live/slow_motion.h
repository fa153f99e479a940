// SPDX-License-Identifier: Apache-2.0
// Pictures between steps: in slow motion a step lasts many pictures, and would be seen as a jerk.
#pragma once

#include <deque>
#include <memory>
#include <span>
#include <vector>

#include "app/live/snapshot.h"

namespace mercury {

// Draws some time after the present, a step and a little more, so that there is always a snapshot on either side; what
// is shown lies on the line between the two. Where steps follow each other quickly, and at rest, it is the newest
// snapshot.
class SlowMotion {
 public:
  static constexpr double most_rate = 250;    // steps a second of wall time up to which pictures lie between steps
  static constexpr double allowance = 0.035;  // for a step to be computed, told and taken [s]

  void take(std::shared_ptr<const Snapshot> snapshot);

  struct Shown {
    double time = 0;  // simulated [s]
    std::span<const Vec3> positions;
    std::span<const Telemetry> telemetry;  // but for the centres of mass, of the newest snapshot
  };
  // At that wall time [s]; valid until the next call of either member.
  Shown at(double wall);

 private:
  double wanted(double wall) const;

  std::deque<std::shared_ptr<const Snapshot>> snapshots_;  // of the same robots, oldest first
  double shown_ = 0;                                       // time of the last picture; it never runs backwards
  std::vector<Vec3> positions_;
  std::vector<Telemetry> telemetry_;
};

}  // namespace mercury
