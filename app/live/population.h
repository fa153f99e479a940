// SPDX-License-Identifier: Apache-2.0
// The robots of the window inside a simulation.
#pragma once

#include <map>
#include <memory>
#include <span>
#include <vector>

#include "app/live/snapshot.h"

namespace mercury {

// Makes a simulation follow a list of robots. Whoever stays keeps its state; whoever comes back goes on from where it
// left, unless too many others left since.
class Population {
 public:
  explicit Population(Simulation& simulation) : simulation_(simulation) {}

  // Whether robots came, went, changed places or were replaced; materials are followed as well.
  bool follow(const std::vector<LiveRobot>& wanted);
  // Robots that left are forgotten: time begins anew.
  void forget_departed();
  // The simulation is another one, without robots.
  void start_over();
  const std::shared_ptr<const LiveRobots>& robots() const { return robots_; }
  // Of robots and masses that are there.
  std::vector<Perturbation> perturbations_of(std::span<const LivePerturbation> perturbations) const;

 private:
  struct Departed {
    std::shared_ptr<const Robot> robot;
    State state;
  };
  static constexpr std::size_t most_departed = 5'000'000;  // masses whose state is kept
  void keep_states(const std::vector<LiveRobot>& wanted);
  void forget(RobotId id);
  void arrange(const std::vector<LiveRobot>& wanted);
  void follow_materials(const std::vector<LiveRobot>& wanted, bool arranged);

  Simulation& simulation_;
  std::shared_ptr<const LiveRobots> robots_ = std::make_shared<LiveRobots>(LiveRobots{.mass_offsets = {0}});
  std::map<RobotId, Departed> departed_;
  std::size_t departed_masses_ = 0;
};

}  // namespace mercury
