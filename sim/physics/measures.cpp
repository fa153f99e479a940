// SPDX-License-Identifier: Apache-2.0
#include "sim/physics/measures.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <utility>

#include "sim/physics/contact.h"
#include "sim/physics/environments.h"
#include "sim/physics/integration.h"

namespace mercury {
namespace {

// Bound of ||d| - L| in longest rest lengths: |d| is at most stretch_limit of them, and L between 0 and 2.
constexpr float elastic_reach = stretch_limit + 2;

// The smallest distance at rest of two masses that no spring joins, or `radius` if that is smaller [m].
float nearest_apart(const Robot& robot, float radius) {
  const auto key_of = [](std::uint32_t a, std::uint32_t b) { return std::min(a, b) << 16 | std::max(a, b); };
  std::vector<std::uint32_t> joined;
  joined.reserve(robot.springs.size());
  for (const Spring& spring : robot.springs) joined.push_back(key_of(spring.a, spring.b));
  std::ranges::sort(joined);
  const auto points = static_cast<std::uint32_t>(robot.masses.size());
  const std::uint32_t mask = std::bit_ceil(points) - 1;
  std::vector<std::vector<std::uint32_t>> buckets(mask + 1);
  const auto cell = [&](std::uint32_t point) { return cell_of(robot.masses[point], 1 / radius); };
  for (std::uint32_t i = 0; i < points; ++i) buckets[bucket_of(hash_of(cell(i)), mask)].push_back(i);
  float nearest = radius;
  for (std::uint32_t i = 0; i < points; ++i)
    for (int n = 0; n < half_neighborhood; ++n) {
      const Cell other = cell(i) + neighbor(n);
      for (const std::uint32_t j : buckets[bucket_of(hash_of(other), mask)]) {
        if ((n == 0 && j <= i) || !(cell(j) == other)) continue;
        const float distance = length(robot.masses[j] - robot.masses[i]);
        if (distance < nearest && !std::ranges::binary_search(joined, key_of(i, j))) nearest = distance;
      }
    }
  return nearest;
}

// The largest power of two p with p * range <= spring_limit_units.
float power_of_two_within(float range) { return std::exp2(std::floor(std::log2(spring_limit_units / range))); }

}  // namespace

RobotMeasures measure(const Robot& robot) {
  RobotMeasures measures;
  for (const Face& face : robot.faces) {
    const Vec3 a = robot.masses[face.a];
    measures.largest_face =
        std::max(measures.largest_face, length(cross(robot.masses[face.b] - a, robot.masses[face.c] - a)) / 2);
  }
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

float stiffest_spring(const RobotMeasures& measures, std::span<const Material> materials) {
  float stiffest = 0;
  for (std::size_t id = 0; id < materials.size(); ++id)
    if (measures.used[id]) stiffest = std::max(stiffest, materials[id].stiffness);
  return stiffest;
}

bool has_viscous_springs(const RobotMeasures& measures, std::span<const Material> materials) {
  for (std::size_t id = 0; id < materials.size(); ++id)
    if (measures.used[id] && materials[id].relaxation_time > 0) return true;
  return false;
}

std::optional<float> common_relaxation_time(const RobotMeasures& measures, std::span<const Material> materials) {
  std::optional<float> common;
  for (std::size_t id = air + 1; id < materials.size(); ++id) {
    if (!measures.used[id]) continue;
    if (common && *common != materials[id].relaxation_time) return std::nullopt;
    common = materials[id].relaxation_time;
  }
  return common;
}

float contact_distance(const Robot& robot, const RobotMeasures& measures, const Environment& environment) {
  constexpr float always = 0.5f;
  const float wanted = environment.contacts ? environment.contacts->contact_distance : always;
  if (wanted <= always || !has_contacts(environment)) return measures.shortest * std::min(wanted, always);
  const float apart = nearest_apart(robot, wanted * measures.shortest / 0.95f);
  return std::max(always * measures.shortest, std::min(wanted * measures.shortest, 0.95f * apart));
}

FixedPointScale fixed_point_scale(const RobotMeasures& measures, std::span<const Material> materials,
                                  const Configuration& configuration, float contact_distance,
                                  const InertiaRange& inertia) {
  const float stiffest = stiffest_spring(measures, materials);
  const float scale = stiffness_scale_of(configuration.environment);
  const float stiffness = std::max(stiffest * scale, 1e-6f);
  const float reach = has_viscous_springs(measures, materials) ? elastic_reach + viscous_limit : elastic_reach;
  const float least_range = 16 * std::min(1.0f, inertia.lightest);  // [N]
  float range = std::max(least_range, stiffness * reach * measures.longest);
  if (const auto& contacts = configuration.environment.contacts)
    range = std::max(range, unlimited_contact_stiffness(*contacts, stiffest) * scale * contact_distance);
  const float compliance =
      static_cast<float>(1 / (static_cast<double>(stiffness) * configuration.dt * configuration.dt));
  const float longest = std::max(measures.longest, min_rest_length);
  FixedPointScale units{power_of_two_within(range),
                        power_of_two_within(reach * longest / (2 / inertia.heaviest + compliance)), 1};
  units.environment = units.force;
  if (const auto* water = std::get_if<ResistiveDrag>(&configuration.environment.water)) {
    constexpr float fastest = 20, larger = 2;  // [m/s], [1]
    const float pressure =
        water->density / 2 * fastest * fastest * std::max(water->normal_coefficient, water->tangential_coefficient);
    float environment = std::max(pressure * larger * measures.largest_face, 1000 * std::min(1.0f, inertia.lightest));
    if (const auto& contacts = configuration.environment.contacts)
      environment = std::max(environment, unlimited_contact_stiffness(*contacts, stiffest) * scale * contact_distance);
    units.environment = power_of_two_within(environment * (spring_limit_units / face_limit_units));
  }
  return units;
}

double xpbd_softening(const Robot& robot, const Configuration& configuration) {
  const std::vector<std::uint32_t> valence = valences(robot);
  const std::vector<PointProperties> points = point_properties(robot, configuration.environment);
  const std::span<const Material> materials = materials_of(robot);
  const auto at = [&](std::uint16_t mass) {
    return static_cast<double>(valence[mass]) * static_cast<double>(points[mass].inverse_inertia);
  };
  double most = 0;
  for (const Spring& spring : robot.springs)
    most = std::max(most, (at(spring.a) + at(spring.b)) * static_cast<double>(materials[spring.material].stiffness));
  return most * static_cast<double>(stiffness_scale_of(configuration.environment)) * configuration.dt *
         configuration.dt;
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
