// SPDX-License-Identifier: Apache-2.0
// Keeps the robots of a simulation equal to the window's list of robots.
#pragma once

#include <map>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "app/live/snapshot.h"
#include "mercury/robot.h"
#include "mercury/state.h"

namespace mercury {

// A robot that stays keeps its state. A robot that was removed and comes back continues from its last state, unless too
// many others were removed since. Not thread-safe; the physics thread owns it.
class Population {
 public:
  // `revision`: of the empty list of robots.
  explicit Population(Simulation& simulation, std::uint64_t revision = 0)
      : simulation_(simulation),
        robots_(std::make_shared<LiveRobots>(LiveRobots{.revision = revision, .mass_offsets = {0}})) {}

  // Adds, removes and orders the robots of the simulation as in `wanted`, and sets their materials and what is held of
  // them by hand. Returns whether the list changed; materials and what is held do not count.
  bool follow(const std::vector<LiveRobot>& wanted);
  // Where new robots begin, and all after return_to_start().
  void set_start(const TrialStart& start) { start_ = start; }
  const TrialStart& start() const { return start_; }
  // Puts all robots to where they begin, at time 0.
  void return_to_start() { begin_at(simulation_, start_); }
  // Keeps the clock and the states of all robots under a number, in place of those that it had. The oldest numbers are
  // forgotten if the states fill the memory.
  void keep_surroundings(std::uint64_t number);
  // Goes back to the clock and the states kept under a number, and forgets the number. Robots without one stay as they
  // are. Returns whether there were any.
  bool restore_surroundings(std::uint64_t number);
  // Stops all robots that have not exploded where they are.
  void settle();
  // Forgets the states of removed robots and of other surroundings: time starts again at 0.
  void forget_departed();
  // Call it after the simulation was replaced by an empty one.
  void start_over();
  const std::shared_ptr<const LiveRobots>& robots() const { return robots_; }
  // Translates perturbations for the simulation. Leaves out those on missing robots and masses.
  std::vector<Perturbation> perturbations_of(std::span<const LivePerturbation> perturbations) const;

 private:
  // A removed robot.
  struct Departed {
    std::shared_ptr<const Robot> robot;
    State state;
  };
  static constexpr std::size_t most_departed = 5'000'000;  // masses of removed robots whose state is kept
  void keep_states(const std::vector<LiveRobot>& wanted);
  void forget(RobotId id);
  void arrange(const std::vector<LiveRobot>& wanted);
  void begin_as(const std::vector<LiveRobot>& wanted, const std::vector<std::size_t>& indices, std::size_t robot);
  void follow_materials(const std::vector<LiveRobot>& wanted, bool arranged);
  void follow_drives(const std::vector<LiveRobot>& wanted, bool arranged);
  void follow_neurons(const std::vector<LiveRobot>& wanted);

  Simulation& simulation_;
  std::shared_ptr<const LiveRobots> robots_;
  std::map<RobotId, Departed> departed_;
  struct Surroundings {
    Clock clock;
    std::map<RobotId, Departed> states;
  };
  std::map<std::uint64_t, Surroundings> surroundings_;
  TrialStart start_;
  bool held_ = false;  // drives were held by hand
  std::size_t departed_masses_ = 0;
};

// The state of a robot whose body was edited.
//
// Masses of `after` that were in `before`, at the same place at rest, go on as they are in `state`. New masses are as
// far from their place at rest as the nearest mass that was there, and move with its velocity. None if the robot had
// exploded or no mass stayed.
std::optional<State> carried_state(const Robot& before, const State& state, const Robot& after);

}  // namespace mercury
