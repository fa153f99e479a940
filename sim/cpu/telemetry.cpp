// SPDX-License-Identifier: Apache-2.0
#include "sim/cpu/backend.h"

#include <array>
#include <vector>

#include "mercury/observables.h"

namespace mercury::cpu {
namespace {

struct Sum {
  double x = 0, y = 0, z = 0;
  void add(double mass, Vec3 a) {
    x += mass * static_cast<double>(a.x);
    y += mass * static_cast<double>(a.y);
    z += mass * static_cast<double>(a.z);
  }
  Vec3 over(double mass) const {
    return {static_cast<float>(x / mass), static_cast<float>(y / mass), static_cast<float>(z / mass)};
  }
};

}  // namespace

Telemetry measure_state(const Kernel& kernel, const Body& body, const Configuration& configuration,
                        const Clock& clock) {
  Telemetry result;
  Sum position, velocity;
  double total_mass = 0;
  const std::size_t masses = body.robot->masses.size();
  Aligned<float> positions(4 * masses);
  for (std::size_t i = 0; i < masses; ++i) {
    const Vec3 x = body.position(i), v = body.velocity(i);
    positions[4 * i] = x.x;
    positions[4 * i + 1] = x.y;
    positions[4 * i + 2] = x.z;
    const auto mass = static_cast<double>(mass_of(*body.robot, i));
    total_mass += mass;
    position.add(mass, x);
    velocity.add(mass, v);
    result.kinetic_energy +=
        0.5 * mass *
        (static_cast<double>(v.x) * static_cast<double>(v.x) + static_cast<double>(v.y) * static_cast<double>(v.y) +
         static_cast<double>(v.z) * static_cast<double>(v.z));
  }
  result.center_of_mass = position.over(total_mass);
  result.velocity = velocity.over(total_mass);
  alignas(16) std::array<float, 4 * max_materials> materials;
  for (std::size_t id = 0; id < body.materials.size(); ++id) {
    if (!body.measures.used[id]) continue;
    const MaterialNow now = material_at(body.materials[id], configuration.environment, clock);
    materials[4 * id] = now.stiffness;
    materials[4 * id + 1] = now.length_factor;
    materials[4 * id + 2] = now.length_rate;
    materials[4 * id + 3] = 0;
  }
  const std::vector<Spring>& springs = body.robot->springs;
  const SpringMeasures measures = kernel.measure_springs(springs, positions.data(), materials.data());
  result.elastic_energy = measures.elastic_energy;
  result.muscle_power = measures.muscle_power;
  result.largest_strain = measures.largest_strain;
  result.strained_share = strained_share(measures.strained, static_cast<std::uint32_t>(springs.size()));
  return result;
}

}  // namespace mercury::cpu
