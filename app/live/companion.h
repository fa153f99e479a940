// SPDX-License-Identifier: Apache-2.0
// A second batch of robots that goes along with the first one, for comparison: the same robots under another
// configuration, or ghosts of robots as they were before a change.
//
//   first     ---*------+------+---x----+--->   steps; x: robots, parameters or materials change
//                | copy |      |   | same change
//   companion    *------+------+---x----+--->
//
// The companion begins at a moment of the first batch, in the states that its robots have then. From there on it is
// stepped after each slice of the first batch's steps, on the same thread, so that both always show the same time.
// Before that moment both were one: an earlier moment of the timeline shows copies. The keyframes of later moments hold
// the states of both.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "app/live/measurements.h"
#include "app/live/population.h"
#include "app/live/snapshot_pool.h"
#include "app/scene/view_settings.h"

namespace mercury {

// The first batch.
struct Leader {
  const Simulation& simulation;
  const Population& population;
  const Measurements& measurements;
  std::uint64_t surroundings = 0;
};

// What a companion simulates. A robot has the id of the robot of the first batch that it is compared with.
struct CompanionRobots {
  std::vector<LiveRobot> robots;
  Configuration configuration;
  std::vector<LivePerturbation> perturbations;
};

// Not thread-safe, except that anybody may read its measurements; the physics thread owns it.
class Companion {
 public:
  // `number`: of the companions so far. Pictures know by it that it is another one.
  Companion(const Configuration& configuration, Measurements& measurements, std::uint64_t number);

  // Begins at the first batch's present moment. A robot that is joined as its partner is takes the state of its
  // partner, and others are at rest. At step 0, all are as a reset leaves them.
  void begin(const CompanionRobots& wanted, const Leader& leader);
  // Follows changes of robots, parameters, materials and perturbations.
  void follow(const CompanionRobots& wanted, const Leader& leader);
  // Steps to the first batch's time, the nearest that its own time step allows.
  void advance(const Leader& leader);
  // Puts it into a state of save(). The robots are those of that moment.
  void restore(const BatchState& state);
  BatchState save() const { return simulation_.save(); }
  // The step of the first batch at which it began. Until then both were one: show_common_past() copies the first batch.
  std::int64_t begin_step() const { return begin_step_; }
  void show_common_past(const CompanionRobots& wanted, const Leader& leader);
  // The first batch went back to an earlier moment, which is the present now.
  void forget_later(const CompanionRobots& wanted, const Leader& leader);

  // Takes a sample of its measures, at the first batch's step.
  void observe(std::int64_t step);
  void watch(const ViewSettings& view);  // selects the details of its snapshots; none without a call
  std::shared_ptr<Snapshot> snapshot(bool with_velocities);

 private:
  void copy(const CompanionRobots& wanted, const Leader& leader);
  void observe_details();

  Simulation simulation_;
  Population population_;
  Measurements& measurements_;
  std::uint64_t surroundings_ = 0, jumps_ = 0;
  std::int64_t begin_step_ = 0;
  std::vector<LivePerturbation> perturbations_;
  std::vector<Telemetry> telemetry_;
  std::optional<ViewSettings> view_;
  std::optional<DetailObserver> details_;
  SnapshotPool pool_;
};

}  // namespace mercury
