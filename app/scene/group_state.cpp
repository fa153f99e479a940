// SPDX-License-Identifier: Apache-2.0
#include "app/scene/group_state.h"

namespace mercury {

GroupState read_state(const Simulation& simulation) {
  GroupState state{.time = simulation.time(),
                   .positions = std::vector<Vec3>(simulation.mass_count()),
                   .velocities = std::vector<Vec3>(simulation.mass_count()),
                   .driven = simulation.driven_materials()};
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

std::vector<MaterialNow> materials_at(const Simulation& simulation, std::size_t robot, const GroupState& state) {
  return materials_at(state.driven.of(robot, materials_of(simulation, robot)), simulation.configuration().environment,
                      state.time);
}

std::vector<FloorForce> floor_forces(const Simulation& simulation, std::size_t robot, const GroupState& state) {
  const Configuration& configuration = simulation.configuration();
  return floor_forces(simulation.robot(robot), configuration, materials_at(simulation, robot, state),
                      masses_of(simulation, robot, state.positions), masses_of(simulation, robot, state.velocities));
}

std::vector<Vec3> net_forces(const Simulation& simulation, std::size_t index, const GroupState& state) {
  const Robot& robot = simulation.robot(index);
  const Environment& environment = simulation.configuration().environment;
  const auto positions = masses_of(simulation, index, state.positions);
  const auto velocities = masses_of(simulation, index, state.velocities);
  std::vector<Vec3> forces = spring_forces(robot, materials_at(simulation, index, state), positions);
  for (std::size_t i = 0; i < forces.size(); ++i)
    forces[i] += mass_force(environment, mass_of(robot, i), velocities[i]);
  if (has_face_forces(environment)) {
    const std::vector<std::uint16_t> behind = masses_behind_faces(robot, environment);
    for (std::size_t i = 0; i < robot.faces.size(); ++i) {
      const Face& face = robot.faces[i];
      const FaceForce force = face_force(environment, face, positions, velocities, behind[i]);
      for (const std::uint16_t corner : {face.a, face.b, face.c})
        forces[corner] = forces[corner] + (1.0f / 3) * (force.drag + force.lift);
    }
  }
  for (const FloorForce& contact : floor_forces(simulation, index, state))
    forces[contact.mass] = forces[contact.mass] + contact.force;
  for (const std::uint16_t fixed : robot.fixed) forces[fixed] = Vec3{};
  return forces;
}

}  // namespace mercury
