// SPDX-License-Identifier: Apache-2.0
#include "sim/physics/measures.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <span>
#include <utility>
#include <vector>

#include "sim/physics/contact.h"
#include "sim/physics/environments.h"
#include "sim/physics/integration.h"
#include "sim/physics/points.h"

namespace mercury {
namespace {

// Bound of ||d| - L| in longest rest lengths: |d| is at most stretch_limit of them, and L between 0 and 2.
constexpr float elastic_reach = stretch_limit + 2;

// The smallest distance at rest of two masses that no spring joins, or `radius` if that is smaller [m].
float nearest_apart(const Robot& robot, float radius) {
  const auto key_of = [](std::uint32_t a, std::uint32_t b) { return std::min(a, b) << 16 | std::max(a, b); };
  std::vector<std::uint32_t> joined;  // made when it is needed: most bodies have no masses that near
  const auto is_joined = [&](std::uint32_t a, std::uint32_t b) {
    if (joined.empty()) {
      for (const Spring& spring : robot.springs) joined.push_back(key_of(spring.a, spring.b));
      std::ranges::sort(joined);
    }
    return std::ranges::binary_search(joined, key_of(a, b));
  };
  const auto points = static_cast<std::uint32_t>(robot.masses.size());
  const std::uint32_t mask = std::bit_ceil(points) - 1;
  std::vector<Cell> cells;
  cells.reserve(points);
  for (const Vec3& x : robot.masses) cells.push_back(cell_of(x, 1 / radius));
  // The masses of a bucket form a list.
  constexpr std::uint32_t none = 0xffffffff;
  std::vector<std::uint32_t> first_in(mask + 1, none), next(points);
  for (std::uint32_t i = points; i-- > 0;) next[i] = std::exchange(first_in[bucket_of(hash_of(cells[i]), mask)], i);
  float nearest = radius;
  for (std::uint32_t i = 0; i < points; ++i)
    for (int n = 0; n < half_neighborhood; ++n) {
      const Cell other = cells[i] + neighbor(n);
      for (std::uint32_t j = first_in[bucket_of(hash_of(other), mask)]; j != none; j = next[j]) {
        if ((n == 0 && j <= i) || !(cells[j] == other)) continue;
        const float distance = length(robot.masses[j] - robot.masses[i]);
        if (distance < nearest && !is_joined(i, j)) nearest = distance;
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

float highest_length_rate(const RobotMeasures& measures, std::span<const Material> materials) {
  float slowest = 0;
  for (std::size_t id = 0; id < materials.size(); ++id)
    if (measures.used[id]) slowest = std::max(slowest, materials[id].relaxation_time);
  return slowest > 0 ? viscous_limit * measures.longest / slowest : 0;
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

namespace {

// At most how strongly the springs of a mass hold it if its partners stay: with n along a spring of strength k and K =
// sum k n n' for each mass, the largest eigenvalue of any K, or a little more. No eigenvalue of the whole body is
// larger than twice that, since (n.u_a - n.u_b)^2 <= 2 (n.u_a)^2 + 2 (n.u_b)^2.
template <class Strength>
double strongest_hold(const Robot& robot, const Strength& strength) {
  struct Symmetric {
    double xx = 0, yy = 0, zz = 0, xy = 0, xz = 0, yz = 0;
  };
  std::vector<Symmetric> holds(robot.masses.size());
  for (const Spring& spring : robot.springs) {
    const Vec3 d = robot.masses[spring.b] - robot.masses[spring.a];
    const double x = static_cast<double>(d.x), y = static_cast<double>(d.y), z = static_cast<double>(d.z);
    const double squared = x * x + y * y + z * z;
    if (!(squared > 0)) continue;
    for (const std::uint16_t mass : {spring.a, spring.b}) {
      const double k = strength(spring, mass) / squared;
      Symmetric& hold = holds[mass];
      hold.xx += k * x * x;
      hold.yy += k * y * y;
      hold.zz += k * z * z;
      hold.xy += k * x * y;
      hold.xz += k * x * z;
      hold.yz += k * y * z;
    }
  }
  double most = 0;
  for (const Symmetric& hold : holds) {
    const double xy = std::abs(hold.xy), xz = std::abs(hold.xz), yz = std::abs(hold.yz);
    most = std::max({most, hold.xx + xy + xz, hold.yy + xy + yz, hold.zz + xz + yz});
  }
  return most;
}

}  // namespace

double exceeded_dt(const Robot& robot, const Configuration& configuration) {
  constexpr double none = std::numeric_limits<double>::infinity();
  if (configuration.solver != Solver::force) return none;
  const std::vector<PointProperties> points = point_properties(robot, configuration.environment);
  const std::span<const Material> materials = materials_of(robot);
  const double scale = static_cast<double>(stiffness_scale_of(configuration.environment)), dt = configuration.dt;
  const auto inverse = [&](std::size_t mass) { return static_cast<double>(points[mass].inverse_inertia); };
  const auto stiffness = [&](const Spring& spring) {
    return scale * static_cast<double>(materials[spring.material].stiffness);
  };
  const auto with_damping = [&](const Spring& spring) {
    return stiffness(spring) * (dt * dt + 2 * dt * static_cast<double>(materials[spring.material].relaxation_time));
  };
  // No eigenvalue is larger than this sum at the two ends of some spring. That is enough for most robots.
  std::vector<double> sums(robot.masses.size());
  for (const Spring& spring : robot.springs)
    for (const std::uint16_t mass : {spring.a, spring.b}) sums[mass] += with_damping(spring) * inverse(mass);
  const auto bound = [&](const Spring& spring) { return sums[spring.a] + sums[spring.b]; };
  if (std::ranges::all_of(robot.springs, [&](const Spring& spring) { return bound(spring) < 4; })) return none;
  if (2 * strongest_hold(
              robot, [&](const Spring& spring, std::uint16_t mass) { return with_damping(spring) * inverse(mass); }) <
      4)
    return none;

  struct Vector {
    double x = 0, y = 0, z = 0;
  };
  // In coordinates scaled by the roots of the inertias.
  struct Pull {
    std::uint16_t a, b;
    double at_a, at_b;
    Vector along;  // of length 1
    double stiffness, viscous, with_damping;
  };
  std::vector<Pull> pulls;
  pulls.reserve(robot.springs.size());
  for (const Spring& spring : robot.springs) {
    const Vec3 along = robot.masses[spring.b] - robot.masses[spring.a];
    const double squared_length = static_cast<double>(dot(along, along));
    if (!(squared_length > 0)) continue;
    const double share = 1 / std::sqrt(squared_length), k = stiffness(spring);
    pulls.push_back({spring.a,
                     spring.b,
                     std::sqrt(inverse(spring.a)),
                     std::sqrt(inverse(spring.b)),
                     {share * static_cast<double>(along.x), share * static_cast<double>(along.y),
                      share * static_cast<double>(along.z)},
                     k,
                     k * static_cast<double>(materials[spring.material].relaxation_time),
                     with_damping(spring)});
  }
  // Powers of the matrix turn any start to the stiffest vibration.
  std::vector<Vector> u(robot.masses.size()), next(u.size());
  std::uint64_t number = 1;
  const auto random = [&] {
    number = number * 6364136223846793005u + 1442695040888963407u;
    return static_cast<double>(number >> 33) / 2147483648.0 - 0.5;
  };
  for (Vector& own : u) own = {random(), random(), random()};
  constexpr int turns = 60;
  double a = 0, b = 0;
  for (int turn = 0; turn <= turns; ++turn) {
    double squared = 0;
    for (std::size_t i = 0; i < u.size(); ++i)
      if (inverse(i) > 0) squared += u[i].x * u[i].x + u[i].y * u[i].y + u[i].z * u[i].z;
    if (!(squared > 0)) return none;
    const double norm = 1 / std::sqrt(squared);
    for (Vector& own : u) own = {norm * own.x, norm * own.y, norm * own.z};
    std::ranges::fill(next, Vector{});
    a = b = 0;
    for (const Pull& p : pulls) {
      const Vector& n = p.along;
      const auto part = [&](const Vector& own) { return own.x * n.x + own.y * n.y + own.z * n.z; };
      const double longer = p.at_b * part(u[p.b]) - p.at_a * part(u[p.a]);
      a += p.stiffness * longer * longer;
      b += p.viscous * longer * longer;
      const double pull = p.with_damping * longer;
      Vector &on_a = next[p.a], &on_b = next[p.b];
      on_a = {on_a.x - p.at_a * pull * n.x, on_a.y - p.at_a * pull * n.y, on_a.z - p.at_a * pull * n.z};
      on_b = {on_b.x + p.at_b * pull * n.x, on_b.y + p.at_b * pull * n.y, on_b.z + p.at_b * pull * n.z};
    }
    std::swap(u, next);
  }
  const double allowed = 4 / (b + std::sqrt(b * b + 4 * a));  // a dt^2 + 2 b dt = 4
  return allowed < dt ? allowed : none;
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
