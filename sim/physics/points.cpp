// SPDX-License-Identifier: Apache-2.0
#include "sim/physics/points.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "sim/physics/double3.h"

namespace mercury {
namespace {

// Twice the area, along the outer normal.
Double3 area_vector(const Robot& robot, const Face& face) {
  const Double3 a(robot.masses[face.a]), b(robot.masses[face.b]), c(robot.masses[face.c]);
  return cross(b - a, c - a);
}

// [m3], one per mass.
std::vector<double> displaced_volumes(const Robot& robot) {
  std::vector<double> share(robot.masses.size());
  double area = 0;
  for (const Face& face : robot.faces) {
    const Double3 normal = area_vector(robot, face);
    const double third = std::sqrt(dot(normal, normal)) / 6;
    for (const std::uint16_t corner : {face.a, face.b, face.c}) share[corner] += third;
    area += 3 * third;
  }
  const double volume = std::max(0.0, skin_volume(robot));
  for (double& s : share) s = area > 0 ? s * volume / area : 0;
  return share;
}

}  // namespace

// The divergence theorem: each face and the first mass span a tetrahedron.
double skin_volume(const Robot& robot) {
  const Double3 origin(robot.masses.front());
  double volume = 0;
  for (const Face& face : robot.faces)
    volume += dot(area_vector(robot, face), Double3(robot.masses[face.a]) - origin) / 6;
  return volume;
}

std::vector<PointProperties> point_properties(const Robot& robot, const Environment& environment) {
  std::vector<PointProperties> points(robot.masses.size());
  const auto* water = std::get_if<ResistiveDrag>(&environment.water);
  const std::vector<double> volumes = water ? displaced_volumes(robot) : std::vector<double>(points.size());
  for (std::size_t i = 0; i < points.size(); ++i) {
    const double mass = static_cast<double>(mass_of(robot, i));
    const double displaced = water ? static_cast<double>(water->density) * volumes[i] : 0;
    const double added = water ? static_cast<double>(water->added_mass_coefficient) * displaced : 0;
    points[i] = {static_cast<float>(1 / (mass + added)), static_cast<float>(mass - displaced)};
  }
  for (const std::uint16_t point : robot.fixed) points[point].inverse_inertia = 0;
  return points;
}

InertiaRange inertia_range(std::span<const PointProperties> points) {
  float least = std::numeric_limits<float>::infinity(), most = 0;
  for (const PointProperties& point : points)
    if (point.inverse_inertia > 0) {
      least = std::min(least, point.inverse_inertia);
      most = std::max(most, point.inverse_inertia);
    }
  return most > 0 ? InertiaRange{1 / most, 1 / least} : InertiaRange{};
}

std::vector<Vec3> start_velocities(const Robot& robot) {
  std::vector<Vec3> velocities = robot.velocity;
  velocities.resize(robot.masses.size());
  for (const std::uint16_t point : robot.fixed) velocities[point] = {};
  return velocities;
}

}  // namespace mercury
