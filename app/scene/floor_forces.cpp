// SPDX-License-Identifier: Apache-2.0
#include "app/scene/floor_forces.h"

#include <algorithm>
#include <cmath>
#include <variant>

#include "app/scene/materials_now.h"

namespace mercury {
namespace {

// Hooke's law over all springs of the robot, one force a mass.
std::vector<Vec3> spring_forces(const Simulation& simulation, std::size_t robot, const GroupState& state,
                                std::span<const Vec3> positions) {
  const std::vector<MaterialNow> materials = materials_at(simulation, robot, state.time);
  std::vector<Vec3> forces(positions.size());
  for (const Spring& spring : simulation.robot(robot).springs) {
    const MaterialNow& material = materials[spring.material];
    const Vec3 d = positions[spring.b] - positions[spring.a];
    const float length_now = std::max(length(d), 1e-10f);
    const Vec3 pull = (material.stiffness * (1 - spring.rest_length * material.length_factor / length_now)) * d;
    forces[spring.a] += pull;
    forces[spring.b] += -1.0f * pull;
  }
  return forces;
}

}  // namespace

std::vector<FloorForce> floor_forces(const Simulation& simulation, std::size_t robot, const GroupState& state) {
  const auto* land = std::get_if<Land>(&simulation.configuration().environment);
  if (!land) return {};
  const std::size_t first = simulation.mass_offsets()[robot], count = simulation.robot(robot).masses.size();
  const auto positions = std::span(state.positions).subspan(first, count);
  const auto velocities = std::span(state.velocities).subspan(first, count);
  const std::vector<Vec3> pulls = spring_forces(simulation, robot, state, positions);
  const auto inverse_dt = static_cast<float>(1 / simulation.configuration().dt);
  std::vector<FloorForce> forces;
  for (std::size_t i = 0; i < count; ++i) {
    if (positions[i].z > 0) continue;
    // What it takes to leave a mass of 1 kg where it is.
    const Vec3 hold = -1.0f * (pulls[i] + land->gravity + inverse_dt * velocities[i]);
    if (!(hold.z > 0)) continue;
    const float along = std::hypot(hold.x, hold.y), most = land->friction * hold.z;
    const float share = along > most ? most / along : 1;
    forces.push_back({static_cast<std::uint32_t>(i), {share * hold.x, share * hold.y, hold.z}});
  }
  return forces;
}

}  // namespace mercury
