// SPDX-License-Identifier: Apache-2.0
// Robots for the tests of exports, and numbers taken from files without Mercury's own code.
#pragma once

#include <array>
#include <cstring>
#include <string>
#include <vector>

#include "app/export/exported_robot.h"
#include "mercury/random_voxel.h"

namespace mercury::test {

// A voxel robot whose masses were moved, so that no face is parallel to an axis and no spring is at rest.
struct Bent {
  Robot robot = random_voxel_robot({}, 7);
  std::vector<Vec3> positions, velocities;

  Bent() {
    for (const Vec3 p : robot.masses) {
      positions.push_back({p.x + 0.1f * p.z, 1.1f * p.y - 0.03f * p.x, p.z + 0.2f * p.x * p.y + 0.7f});
      velocities.push_back({0.1f * p.y, -p.x, 0.3f});
    }
  }
  Pose pose(double time = 0) const { return {.time = time, .positions = positions, .velocities = velocities}; }
};

// The number at a place of a file's content.
template <class Number>
Number number_at(const std::string& content, std::size_t place) {
  Number number;
  std::memcpy(&number, content.data() + place, sizeof number);
  return number;
}

using Double3 = std::array<double, 3>;
inline Double3 in_double(Vec3 v) { return {v.x, v.y, v.z}; }
inline Double3 minus(const Double3& a, const Double3& b) { return {a[0] - b[0], a[1] - b[1], a[2] - b[2]}; }
inline Double3 cross(const Double3& a, const Double3& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}
inline double dot(const Double3& a, const Double3& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }

// Enclosed by the skin, by the divergence theorem: the sum of a . (b x c) / 6.
inline double volume_of(const Robot& robot, const std::vector<Vec3>& positions) {
  double sum = 0;
  for (const Face& face : robot.faces)
    sum += dot(in_double(positions[face.a]), cross(in_double(positions[face.b]), in_double(positions[face.c])));
  return sum / 6;
}

}  // namespace mercury::test
