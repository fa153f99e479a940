// SPDX-License-Identifier: Apache-2.0
#include "sim/cpu/advance.h"

#include <algorithm>
#include <cmath>

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

Telemetry measure_state(const Body& body, const Configuration& configuration, const Clock& clock) {
  Telemetry result;
  Sum position, velocity;
  double total_mass = 0;
  const std::size_t masses = body.robot->masses.size();
  for (std::size_t i = 0; i < masses; ++i) {
    const Vec3 v = body.velocity(i);
    const auto mass = static_cast<double>(mass_of(*body.robot, i));
    total_mass += mass;
    position.add(mass, body.position(i));
    velocity.add(mass, v);
    result.kinetic_energy +=
        0.5 * mass *
        (static_cast<double>(v.x) * static_cast<double>(v.x) + static_cast<double>(v.y) * static_cast<double>(v.y) +
         static_cast<double>(v.z) * static_cast<double>(v.z));
  }
  result.center_of_mass = position.over(total_mass);
  result.velocity = velocity.over(total_mass);
  std::array<MaterialNow, max_materials> materials;
  for (std::size_t id = 0; id < body.materials.size(); ++id)
    if (body.measures.used[id]) materials[id] = material_at(body.materials[id], configuration.environment, clock);
  std::uint32_t strained = 0;
  for (const Spring& spring : body.robot->springs) {
    const MaterialNow& material = materials[spring.material];
    const float distance = length(body.position(spring.b) - body.position(spring.a));
    const double stiffness{material.stiffness};
    const double too_long{stretch(distance, spring.rest_length, material.length_factor)};
    const float relative = strain(distance, spring.rest_length);
    result.elastic_energy += elastic_energy(stiffness, too_long);
    result.muscle_power += muscle_power(stiffness, too_long, double{spring.rest_length}, double{material.length_rate});
    result.largest_strain = std::max(result.largest_strain, std::abs(relative));
    strained += is_strained(relative) ? 1 : 0;
  }
  result.strained_share = strained_share(strained, static_cast<std::uint32_t>(body.robot->springs.size()));
  return result;
}

}  // namespace mercury::cpu
