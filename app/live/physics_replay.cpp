// SPDX-License-Identifier: Apache-2.0
// The physics thread makes happen again what led to an explosion.
#include <limits>

#include "app/live/physics_parts.h"

namespace mercury {
namespace {

std::vector<LivePerturbation> live_perturbations(RobotId robot, const std::vector<Perturbation>& perturbations) {
  std::vector<LivePerturbation> live;
  for (const Perturbation& perturbation : perturbations)
    live.push_back({.robot = robot,
                    .mass = perturbation.mass,
                    .target = perturbation.target,
                    .stiffness = perturbation.stiffness});
  return live;
}

}  // namespace

// The one robot there is, at the start of the repro.
void Physics::Parts::begin_replay() {
  LiveRobot robot = population.robots()->robots.front();
  robot.materials.reset();  // the repro's robot has them as they were
  population.follow({robot});
  Configuration configuration = replayed->configuration;
  configuration.device = simulation.configuration().device;
  simulation.configure(configuration);
  simulation.set_clock(replayed->clock);
  simulation.set_state(0, replayed->state);
  perturbations = live_perturbations(robot.id, replayed->perturbations);
  simulation.set_perturbations(population.perturbations_of(perturbations));
  next_change = 0;
  replay_log.follow(simulation, *population.robots(), perturbations);
  watch();
  begin_pace();
}

std::int64_t Physics::Parts::next_change_step() const {
  return replayed && next_change < replayed->changes.size() ? replayed->changes[next_change].step
                                                            : std::numeric_limits<std::int64_t>::max();
}

// Those of the step at which the simulation stands.
void Physics::Parts::make_changes() {
  if (next_change_step() > simulation.steps()) return;
  LiveRobot robot = population.robots()->robots.front();
  for (; next_change_step() <= simulation.steps(); ++next_change) {
    const ReproChange& change = replayed->changes[next_change];
    if (change.configuration) {
      Configuration configuration = *change.configuration;
      configuration.device = simulation.configuration().device;
      simulation.configure(configuration);
      watch();
      begin_pace();
    }
    if (change.materials) {
      robot.materials = std::make_shared<const std::vector<Material>>(*change.materials);
      population.follow({robot});
    }
    if (change.perturbations) perturbations = live_perturbations(robot.id, *change.perturbations);
  }
  simulation.set_perturbations(population.perturbations_of(perturbations));
  replay_log.follow(simulation, *population.robots(), perturbations);
}

}  // namespace mercury
