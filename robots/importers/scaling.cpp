// SPDX-License-Identifier: Apache-2.0
#include "robots/importers/calibration.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <vector>

#include "robots/importers/voxel_body.h"

namespace mercury {
namespace {

// The step at which the force solver is no longer stable [s]. With stiffness K, damping C and masses M it is, as long
// as M - dt C / 2 - dt^2 K / 4 is positive, by Gershgorin if that holds in each row: dt^2 k + 2 dt c < 4, where a row
// has the terms stiffness |n_i n_j| of each spring at that mass twice, once on the diagonal, over the mass.
double limit_of_steps(const Robot& robot, double stiffness_scale) {
  struct Row {
    double stiffness = 0, damping = 0;  // [1/s2], [1/s]
  };
  const auto table = materials_of(robot);
  std::vector<std::array<Row, 3>> rows(robot.masses.size());
  for (const Spring& spring : robot.springs) {
    const Vec3 &a = robot.masses[spring.a], &b = robot.masses[spring.b];
    const std::array d{std::abs(static_cast<double>(b.x) - a.x), std::abs(static_cast<double>(b.y) - a.y),
                       std::abs(static_cast<double>(b.z) - a.z)};
    const double length = std::hypot(d[0], d[1], d[2]), sum = d[0] + d[1] + d[2];
    if (!(length > 0)) continue;
    const double k = static_cast<double>(table[spring.material].stiffness) * stiffness_scale / (length * length);
    for (const std::uint16_t mass : {spring.a, spring.b})
      for (std::size_t axis = 0; axis < 3; ++axis) {
        const double term = 2 * k * d[axis] * sum / static_cast<double>(mass_of(robot, mass));
        rows[mass][axis].stiffness += term;
        rows[mass][axis].damping += term * static_cast<double>(table[spring.material].relaxation_time);
      }
  }
  double limit = std::numeric_limits<double>::infinity();
  for (const auto& row : rows)
    for (const auto& [stiffness, damping] : row)
      if (stiffness > 0) limit = std::min(limit, (std::sqrt(damping * damping + 4 * stiffness) - damping) / stiffness);
  return limit;
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
  constexpr double longest = 1e-3, share = 0.5;
  double limit = std::numeric_limits<double>::infinity();
  for (const Robot& robot : robots) limit = std::min(limit, share * limit_of_steps(robot, stiffness_scale));
  for (double decade = longest; decade > 1e-9; decade /= 10)
    for (const double digit : {1.0, 0.5, 0.2})
      if (digit * decade <= limit) return digit * decade;
  return 1e-9;
}

}  // namespace mercury
