// SPDX-License-Identifier: Apache-2.0
#include "robots/importers/calibration.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "robots/importers/voxel_body.h"

namespace mercury {
namespace {

// Bound on the squared frequencies of a robot [1/s2], by Gershgorin: a row of the stiffness matrix, over its mass, has
// the terms k |n_i n_j| of each spring at that mass twice, once on the diagonal.
double largest_eigenvalue(const Robot& robot, double stiffness_scale) {
  const auto table = materials_of(robot);
  std::vector<std::array<double, 3>> rows(robot.masses.size());
  for (const Spring& spring : robot.springs) {
    const Vec3 &a = robot.masses[spring.a], &b = robot.masses[spring.b];
    const std::array d{std::abs(static_cast<double>(b.x) - a.x), std::abs(static_cast<double>(b.y) - a.y),
                       std::abs(static_cast<double>(b.z) - a.z)};
    const double length = std::hypot(d[0], d[1], d[2]), sum = d[0] + d[1] + d[2];
    if (!(length > 0)) continue;
    const double k = static_cast<double>(table[spring.material].stiffness) * stiffness_scale / (length * length);
    for (const std::uint16_t mass : {spring.a, spring.b})
      for (std::size_t axis = 0; axis < 3; ++axis)
        rows[mass][axis] += 2 * k * d[axis] * sum / static_cast<double>(mass_of(robot, mass));
  }
  double largest = 0;
  for (const auto& row : rows) largest = std::max({largest, row[0], row[1], row[2]});
  return largest;
}

}  // namespace

Scaling::Scaling(double edge, double stiffest_modulus, double density, double gravity)
    : model{.elastic_modulus = stiffest_modulus, .density = density, .edge = edge, .gravity = std::abs(gravity)} {
  calibration = calibrate(model, gravity_time_scale(edge));
}

double Scaling::damping(double slow_damping, double share) const {
  BeamModel damped = model;
  damped.slow_damping = slow_damping;
  return calibrate(damped, calibration.time_scale).damping * share;
}

double stable_time_step(std::span<const Robot> robots, double stiffness_scale) {
  double largest = 0;
  for (const Robot& robot : robots) largest = std::max(largest, largest_eigenvalue(robot, stiffness_scale));
  constexpr double longest = 1e-3, share = 0.5;  // of the limit 2 / omega, where a step is no longer stable
  double relaxation_time = 0;
  for (const Robot& robot : robots)
    for (const Material& material : robot.materials)
      relaxation_time = std::max(relaxation_time, static_cast<double>(material.relaxation_time));
  // Below 2 / omega without damping inside.
  const double limit =
      share * (std::sqrt(relaxation_time * relaxation_time + 4 / std::max(largest, 1e-12)) - relaxation_time);
  for (double decade = longest; decade > 1e-9; decade /= 10)
    for (const double digit : {1.0, 0.5, 0.2})
      if (digit * decade <= limit) return digit * decade;
  return 1e-9;
}

}  // namespace mercury
