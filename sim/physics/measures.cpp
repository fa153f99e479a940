// SPDX-License-Identifier: Apache-2.0
#include "sim/physics/measures.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "sim/physics/integration.h"

namespace mercury {
namespace {

// Bound of ||d| - L| in longest rest lengths: |d| is at most stretch_limit of them, and L between 0 and 2.
constexpr float reach = stretch_limit + 2;

// The largest power of two p with p * range <= spring_limit_units.
float power_of_two_within(float range) { return std::exp2(std::floor(std::log2(spring_limit_units / range))); }

}  // namespace

RobotMeasures measure(const Robot& robot) {
  RobotMeasures measures;
  if (robot.springs.empty()) return measures;
  measures.shortest = robot.springs.front().rest_length;
  for (const Spring& spring : robot.springs) {
    measures.longest = std::max(measures.longest, spring.rest_length);
    measures.shortest = std::min(measures.shortest, spring.rest_length);
    measures.used[spring.material] = true;
  }
  return measures;
}

std::vector<std::uint32_t> valences(const Robot& robot) {
  std::vector<std::uint32_t> counts(robot.masses.size());
  for (const Spring& spring : robot.springs) {
    ++counts[spring.a];
    ++counts[spring.b];
  }
  return counts;
}

FixedPointScale fixed_point_scale(const RobotMeasures& measures, std::span<const Material> materials,
                                  const Configuration& configuration) {
  float stiffest = 0;
  for (std::size_t id = 0; id < materials.size(); ++id)
    if (measures.used[id]) stiffest = std::max(stiffest, materials[id].stiffness);
  const float scale = stiffness_scale_of(configuration.environment);
  const float stiffness = std::max(stiffest * scale, 1e-6f);
  constexpr float least_range = 16;  // [N]
  float range = std::max(least_range, stiffness * reach * measures.longest);
  if (const auto& contacts = configuration.environment.contacts)
    range = std::max(range, contacts->contact_stiffness * scale * measures.contact_distance());
  const float compliance =
      static_cast<float>(1 / (static_cast<double>(stiffness) * configuration.dt * configuration.dt));
  const float longest = std::max(measures.longest, min_rest_length);
  return {power_of_two_within(range), power_of_two_within(reach * longest / (2 + compliance))};
}

std::uint32_t culprit_mass(const Robot& robot, const State& state, std::uint32_t noted) {
  if (noted >= state.positions.size()) {
    const auto lost = std::ranges::find_if_not(state.positions, [](Vec3 x) { return within_reach(x); });
    return lost == state.positions.end() ? noted : static_cast<std::uint32_t>(lost - state.positions.begin());
  }
  const auto speed = [&](std::uint32_t mass) {
    const Vec3 v = state.velocities[mass];
    const float squared = dot(v, v);
    const bool sound = within_reach(state.positions[mass]) && std::isfinite(squared);
    return sound ? squared : std::numeric_limits<float>::infinity();
  };
  std::vector<bool> near(state.positions.size());
  near[noted] = true;
  for (int ring = 0; ring < 2; ++ring) {
    const std::vector<bool> before = near;
    for (const Face& face : robot.faces)
      if (before[face.a] || before[face.b] || before[face.c]) near[face.a] = near[face.b] = near[face.c] = true;
  }
  std::uint32_t worst = noted;
  for (std::uint32_t mass = 0; mass < near.size(); ++mass)
    if (near[mass] && speed(mass) > speed(worst)) worst = mass;
  return worst;
}

std::uint32_t culprit_spring(const Robot& robot, std::span<const Vec3> positions, std::uint32_t bad_mass) {
  const auto index_of = [&](auto found) {
    return static_cast<std::uint32_t>(std::distance(robot.springs.begin(), found));
  };
  const auto has_bad_mass = [&](const Spring& spring) { return spring.a == bad_mass || spring.b == bad_mass; };
  if (const auto found = std::ranges::find_if(robot.springs, has_bad_mass); found != robot.springs.end())
    return index_of(found);
  const float limit = measure(robot).squared_stretch_limit();
  // Neighbors of the failing spring may exceed the limit in the same step, but by less.
  const auto strain = [&](const Spring& spring) {
    const Vec3 d = positions[spring.b] - positions[spring.a];
    const float squared = dot(d, d);
    const float own = std::abs(std::sqrt(squared) - spring.rest_length) / spring.rest_length;
    return squared <= limit ? std::pair{false, own} : std::pair{true, std::isnan(own) ? INFINITY : own};
  };
  const auto most = std::ranges::max_element(robot.springs, {}, strain);
  return most == robot.springs.end() ? no_spring : index_of(most);
}

}  // namespace mercury
