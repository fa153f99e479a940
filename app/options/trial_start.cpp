// SPDX-License-Identifier: Apache-2.0
#include "app/options/trial_start.h"

#include <algorithm>
#include <iterator>

#include "app/options/parameter_options.h"
#include "mercury/error.h"

namespace mercury {

bool is_of_start(std::string_view parameter) {
  constexpr std::string_view names[] = {"target_radius", "target_spread", "target_sphere", "turned"};
  return std::ranges::find(names, parameter) != std::end(names);
}

void add_start_options(const Command& command, TrialSettings& trials) {
  add_parameters(command, trials, trials_group, is_of_start);
}

void require_start_of_recording(const TrialSettings& trials) {
  if (begins_elsewhere(trials))
    throw InputError(trials.target_radius > 0 ? "--target-radius" : "--turned",
                     "a recording has its own start; give robots to simulate");
}

std::vector<Vec3> start_of(const Robot& robot, const Environment& environment, const TrialStart& start) {
  std::vector<Vec3> positions = robot.masses;
  if (start.is_elsewhere()) begin_trial(robot, start.trials, environment, start.seed, 0, positions);
  if (!has_ground(environment)) return positions;
  const float lift = -std::ranges::min(positions, {}, &Vec3::z).z;
  for (Vec3& position : positions) position.z += lift;
  return positions;
}

void begin_at(Simulation& simulation, const TrialStart& start) {
  if (!start.is_elsewhere()) return simulation.reset();
  std::vector<Vec3> positions;
  for (std::size_t i = 0; i < simulation.size(); ++i)
    std::ranges::copy(start_of(simulation.robot(i), simulation.configuration().environment, start),
                      std::back_inserter(positions));
  simulation.reset_to(positions);
}

void begin_at(Simulation& simulation, std::size_t robot, const TrialStart& start) {
  if (!start.is_elsewhere()) return;
  State state = simulation.state(robot);
  state.positions = start_of(simulation.robot(robot), simulation.configuration().environment, start);
  simulation.set_state(robot, state);
}

}  // namespace mercury
