// SPDX-License-Identifier: Apache-2.0
#include "sim/physics/face_backs.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "sim/physics/double3.h"

namespace mercury {

FaceBacks::FaceBacks(const Robot& robot) : robot_(robot), start_(robot.masses.size() + 1) {
  for (const Spring& spring : robot.springs) ++start_[spring.a], ++start_[spring.b];
  std::exclusive_scan(start_.begin(), start_.end(), start_.begin(), 0u);
  std::vector<std::uint32_t> next(start_.begin(), start_.end() - 1);
  neighbors_.resize(start_.back());
  for (const Spring& spring : robot.springs) {
    neighbors_[next[spring.a]++] = spring.b;
    neighbors_[next[spring.b]++] = spring.a;
  }
  for (std::size_t mass = 0; mass < robot.masses.size(); ++mass)
    std::sort(neighbors_.begin() + start_[mass], neighbors_.begin() + start_[mass + 1]);
}

std::span<const std::uint16_t> FaceBacks::neighbors(std::uint16_t mass) const {
  return std::span(neighbors_).subspan(start_[mass], start_[mass + 1] - start_[mass]);
}

std::uint16_t FaceBacks::behind(const Face& face) const {
  constexpr double least_depth = 0.1, farther = 1.0001;  // shares of the distance; rounding decides nothing
  const Double3 a(robot_.masses[face.a]), b(robot_.masses[face.b]), c(robot_.masses[face.c]);
  const Double3 normal = cross(b - a, c - a), middle = (1.0 / 3) * (a + b + c);
  const double area = std::sqrt(dot(normal, normal));
  std::uint16_t found = face.a;
  double farthest = 0;
  for (const std::uint16_t mass : neighbors(face.a)) {
    if (!std::ranges::binary_search(neighbors(face.b), mass) || !std::ranges::binary_search(neighbors(face.c), mass))
      continue;
    const Double3 d = Double3(robot_.masses[mass]) - middle;
    const double distance = std::sqrt(dot(d, d));
    if (!(distance > farther * farthest && std::fabs(dot(normal, d)) > least_depth * distance * area)) continue;
    farthest = distance;
    found = mass;
  }
  return found;
}

std::vector<PairBacks> masses_behind(const Robot& robot, std::span<const FacePair> pairs) {
  const FaceBacks backs(robot);
  std::vector<PairBacks> found;
  found.reserve(pairs.size());
  for (const FacePair& p : pairs) found.push_back({backs.behind({p.a, p.b, p.c}), backs.behind({p.a, p.c, p.d})});
  return found;
}

}  // namespace mercury
