// SPDX-License-Identifier: Apache-2.0
// A batch of robots as frames need it: simulated, measured, and observed in the details that the view selects.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "app/live/measurements.h"
#include "app/live/messages.h"
#include "app/live/population.h"
#include "app/scene/view_settings.h"

namespace mercury {

// Not thread-safe, except that anybody may read its measurements; the physics thread owns it.
class LiveBatch {
 public:
  // `revision`: of the empty list of robots.
  LiveBatch(const Configuration& configuration, Measurements& measurements, Messages& messages,
            std::uint64_t revision = 0);

  const Simulation& simulation() const { return simulation_; }
  const Configuration& configuration() const { return simulation_.configuration(); }
  const std::shared_ptr<const LiveRobots>& robots() const { return population_.robots(); }
  const std::vector<LivePerturbation>& perturbations() const { return perturbations_; }
  const std::vector<Telemetry>& telemetry() const { return telemetry_; }  // of the last sample()
  std::uint64_t surroundings() const { return surroundings_; }            // see PhysicsThread::set_scene()
  double time() const { return simulation_.time(); }                      // [s]
  std::int64_t steps() const { return simulation_.steps(); }
  bool empty() const { return simulation_.size() == 0; }

  // What is simulated. The device stays. If robots cannot be simulated, for example for lack of memory, the batch is
  // empty, and the error is thrown on. After follow() and move(), nothing pulls at the robots until perturb().
  void configure(Configuration configuration);
  bool follow(const std::vector<LiveRobot>& robots);  // returns whether the list changed
  // The same in these surroundings: robots get the states that they had there, or are set down on ground.
  bool move(const std::vector<LiveRobot>& robots, const Configuration& configuration, std::uint64_t surroundings);
  void perturb(std::vector<LivePerturbation> perturbations);
  // Where robots begin that are new, and all after a reset; the others stay where they are.
  void set_start(const TrialStart& start) { population_.set_start(start); }
  const TrialStart& start() const { return population_.start(); }
  // Simulates these robots in the states of their partners in `first`, those of the same id, at its time. Robots that
  // are not joined as their partner is are where they begin. At step 0, robots that begin at rest are as a reset leaves
  // them. Returns whether the list changed.
  bool copy(const LiveBatch& first, const std::vector<LiveRobot>& robots, const Configuration& configuration);

  // States. A jump in time is counted; snapshots say how many there were.
  void step(std::int64_t count) { simulation_.step(count); }
  void reset();                                        // time 0, where robots begin; forgets removed ones
  void begin(const Clock& clock, const State& state);  // of the only robot
  void restore(const BatchState& state, bool jumps = true);

  // Measures.
  void sample() { telemetry_ = simulation_.telemetry(); }
  void restart_measures();          // time starts again
  void measure_robots();            // the list of robots changed
  void measure(std::int64_t step);  // with the telemetry of the last sample(), if one is due at this step
  void measure() { measure(steps()); }
  void cut_measures(std::int64_t step) { measurements_.cut(time(), step); }
  void branch_measures(const LiveBatch& first);  // continues those of partners
  std::int64_t next_measure() const { return measurements_.next_step(); }
  void thin_measures() { measurements_.thin_out(); }

  // Pictures.
  void watch(const ViewSettings& view);  // selects the details of snapshots; none without a call
  void set_bridge(std::shared_ptr<PositionBridge> bridge) { bridge_ = std::move(bridge); }  // null = to the host
  // All but who plays and how fast.
  std::shared_ptr<Snapshot> snapshot(bool with_velocities);
  // Of a robot that has a brain; else nothing.
  std::optional<BrainActivity> brain_of(RobotId robot) const;

 private:
  void observe_details();
  void take_positions(SnapshotPositions& positions);

  Simulation simulation_;
  Population population_;
  Measurements& measurements_;
  Messages& messages_;
  std::vector<LivePerturbation> perturbations_;
  std::vector<Telemetry> telemetry_;
  std::uint64_t surroundings_ = 0, jumps_ = 0;
  std::optional<ViewSettings> view_;
  std::optional<DetailObserver> details_;
  std::shared_ptr<PositionBridge> bridge_;
  SnapshotPool pool_;
};

}  // namespace mercury
