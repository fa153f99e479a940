// SPDX-License-Identifier: Apache-2.0
// Replays a repro on the physics thread: the same start and the same changes at the same steps.
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

// Puts the only robot at the start of the repro.
void Physics::Parts::begin_replay() {
  LiveRobot robot = population.robots()->robots.front();
  robot.materials.reset();  // the repro's robot has the materials of the start
  population.follow({robot});
  Configuration configuration = replayed_repro->configuration;
  configuration.device = simulation.configuration().device;
  simulation.configure(configuration);
  simulation.set_clock(replayed_repro->clock);
  simulation.set_state(0, replayed_repro->state);
  perturbations = live_perturbations(robot.id, replayed_repro->perturbations);
  simulation.set_perturbations(population.perturbations_of(perturbations));
  next_change = 0;
  replay_log.follow(simulation, *population.robots(), perturbations);
  timeline.note(simulation.clock());
  observe_details();
  begin_pace();
}

std::int64_t Physics::Parts::next_change_step() const {
  return replayed_repro && next_change < replayed_repro->changes.size() ? replayed_repro->changes[next_change].step
                                                                        : std::numeric_limits<std::int64_t>::max();
}

// Applies the changes that are due at the present step.
void Physics::Parts::apply_repro_changes() {
  if (next_change_step() > simulation.steps()) return;
  LiveRobot robot = population.robots()->robots.front();
  for (; next_change_step() <= simulation.steps(); ++next_change) {
    const ReproChange& change = replayed_repro->changes[next_change];
    if (change.configuration) {
      Configuration configuration = *change.configuration;
      configuration.device = simulation.configuration().device;
      simulation.configure(configuration);
      observe_details();
      begin_pace();
    }
    if (change.materials) {
      robot.materials = std::make_shared<const std::vector<Material>>(*change.materials);
      population.follow({robot});
    }
    if (change.perturbations) perturbations = live_perturbations(robot.id, *change.perturbations);
  }
  simulation.set_perturbations(population.perturbations_of(perturbations));
  follow_companions();
  follow_changes(false);
}

}  // namespace mercury
