// SPDX-License-Identifier: Apache-2.0
#include "app/scene/group_state.h"

namespace mercury {

GroupState read_state(const Simulation& simulation) {
  GroupState state{.time = simulation.time(),
                   .positions = std::vector<Vec3>(simulation.mass_count()),
                   .velocities = std::vector<Vec3>(simulation.mass_count())};
  simulation.read_positions(state.positions);
  simulation.read_velocities(state.velocities);
  return state;
}

std::span<const Vec3> masses_of(const Simulation& simulation, std::size_t robot, std::span<const Vec3> all) {
  return all.subspan(simulation.mass_offsets()[robot], simulation.robot(robot).masses.size());
}

std::vector<Material> materials_of(const Simulation& simulation, std::size_t robot) {
  std::vector<Material> table(materials_of(simulation.robot(robot)).size());
  for (std::size_t id = 0; id < table.size(); ++id) table[id] = simulation.material(robot, static_cast<MaterialId>(id));
  return table;
}

std::vector<FloorForce> floor_forces(const Simulation& simulation, std::size_t robot, const GroupState& state) {
  const Configuration& configuration = simulation.configuration();
  const auto materials = materials_at(materials_of(simulation, robot), configuration.environment, state.time);
  return floor_forces(simulation.robot(robot), configuration, materials, masses_of(simulation, robot, state.positions),
                      masses_of(simulation, robot, state.velocities));
}

}  // namespace mercury
