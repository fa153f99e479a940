// SPDX-License-Identifier: Apache-2.0
// Facts about a robot's skin and springs, found by plain counting.
#pragma once

#include <map>
#include <numeric>
#include <set>
#include <utility>
#include <vector>

#include "mercury/robot.h"

namespace mercury {

// Whether each directed edge of a face has a partner in the other direction: the skin is closed and oriented alike.
inline bool half_edges_cancel(const Robot& robot) {
  std::map<std::pair<int, int>, int> balance;
  for (const Face& face : robot.faces)
    for (const auto& [from, to] : {std::pair(face.a, face.b), std::pair(face.b, face.c), std::pair(face.c, face.a)})
      from < to ? ++balance[{from, to}] : --balance[{to, from}];
  for (const auto& [edge, sum] : balance)
    if (sum != 0) return false;
  return true;
}

// By the divergence theorem: a sixth of the sum of the faces' triple products.
inline double enclosed_volume(const Robot& robot) {
  double volume = 0;
  for (const Face& face : robot.faces) {
    const Vec3 a = robot.masses[face.a], b = robot.masses[face.b], c = robot.masses[face.c];
    volume += static_cast<double>(dot(a, cross(b, c))) / 6;
  }
  return volume;
}

inline bool every_spring_is_there_once(const Robot& robot) {
  std::set<std::pair<int, int>> pairs;
  for (const Spring& spring : robot.springs)
    if (spring.a == spring.b || !pairs.insert(std::minmax<int>(spring.a, spring.b)).second) return false;
  return true;
}

// Number of parts that springs do not join to each other.
inline std::size_t spring_components(const Robot& robot) {
  std::vector<std::size_t> root(robot.masses.size());
  std::iota(root.begin(), root.end(), std::size_t{0});
  const auto find = [&](std::size_t i) {
    while (root[i] != i) i = root[i] = root[root[i]];
    return i;
  };
  std::size_t components = root.size();
  for (const Spring& spring : robot.springs)
    if (const auto a = find(spring.a), b = find(spring.b); a != b) {
      root[a] = b;
      --components;
    }
  return components;
}

}  // namespace mercury
