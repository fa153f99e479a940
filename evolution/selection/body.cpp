// SPDX-License-Identifier: Apache-2.0
#include "evolution/selection/behavior.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>
#include <vector>

namespace mercury {
namespace {

struct BodyBox {
  Vec3 lowest, highest;
};

BodyBox bounds_of(const Robot& robot) {
  if (robot.masses.empty()) return {};
  BodyBox box{robot.masses.front(), robot.masses.front()};
  for (const Vec3& x : robot.masses) {
    box.lowest = {std::min(box.lowest.x, x.x), std::min(box.lowest.y, x.y), std::min(box.lowest.z, x.z)};
    box.highest = {std::max(box.highest.x, x.x), std::max(box.highest.y, x.y), std::max(box.highest.z, x.z)};
  }
  return box;
}

// Points in a hash table of cubes. A point within `reach` of another one is in one of the 8 cubes around that one's
// nearest corner, since cubes are twice as wide.
class PointGrid {
 public:
  PointGrid(std::span<const Vec3> points, double reach)
      : points_(points), reach_(reach), cubes_per_meter_(0.5 / reach), first_(std::bit_ceil(2 * points.size()), none),
        next_(points.size(), none) {
    for (std::size_t i = 0; i < points.size(); ++i) {
      std::uint32_t& first = first_[bucket(hash({points[i].x, points[i].y, points[i].z}))];
      next_[i] = first;
      first = static_cast<std::uint32_t>(i);
    }
  }

  // Distance from `x` to the nearest point; infinite if there is none within reach.
  double distance(std::array<double, 3> x) const {
    double nearest = reach_ * reach_;
    bool found = false;
    const std::uint64_t lowest = hash({x[0] - reach_, x[1] - reach_, x[2] - reach_});
    for (std::size_t corner = 0; corner < 8 && nearest > 0; ++corner) {
      std::uint64_t cube = lowest;
      for (std::size_t axis = 0; axis < 3; ++axis) cube += (corner >> axis & 1) * factors[axis];
      for (std::uint32_t i = first_[bucket(cube)]; i != none; i = next_[i]) {
        const double dx = points_[i].x - x[0], dy = points_[i].y - x[1], dz = points_[i].z - x[2];
        const double squared = dx * dx + dy * dy + dz * dz;
        if (squared > nearest) continue;
        nearest = squared;
        found = true;
      }
    }
    return found ? std::sqrt(nearest) : std::numeric_limits<double>::infinity();
  }

 private:
  static constexpr std::uint32_t none = 0xffffffffu;

  // A sum over the axes, so that those of neighbors differ by the factors.
  static constexpr std::array<std::uint64_t, 3> factors{0x9e3779b97f4a7c15u, 0xbf58476d1ce4e5b9u, 0x94d049bb133111ebu};
  std::uint64_t hash(std::array<double, 3> x) const {
    std::uint64_t sum = 0;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const auto place = static_cast<std::int64_t>(std::floor(x[axis] * cubes_per_meter_));
      sum += static_cast<std::uint64_t>(place) * factors[axis];
    }
    return sum;
  }
  std::size_t bucket(std::uint64_t hash) const { return static_cast<std::size_t>(hash >> 32) & (first_.size() - 1); }

  const std::span<const Vec3> points_;
  const double reach_, cubes_per_meter_;
  std::vector<std::uint32_t> first_, next_;
};

double mean_rest_length(const Robot& robot) {
  double sum = 0;
  for (const Spring& spring : robot.springs) sum += spring.rest_length;
  return robot.springs.empty() ? 0 : sum / static_cast<double>(robot.springs.size());
}

}  // namespace

Vec3 box_of(const Robot& robot) {
  const BodyBox box = bounds_of(robot);
  return box.highest - box.lowest;
}

double volume_of(const Robot& robot) {
  if (robot.masses.empty()) return 0;
  const Vec3 corner = robot.masses.front();  // near the body, so that little is lost by cancellation
  double sixfold = 0;
  for (const Face& face : robot.faces) {
    const Vec3 a = robot.masses[face.a] - corner, b = robot.masses[face.b] - corner, c = robot.masses[face.c] - corner;
    sixfold += dot(a, cross(b, c));
  }
  return std::abs(sixfold) / 6;
}

double mirror_symmetry(const Robot& robot) {
  if (robot.masses.empty()) return 1;
  const BodyBox box = bounds_of(robot);
  const double twice_middle = static_cast<double>(box.lowest.y) + box.highest.y;
  const double reach = std::max<double>(mean_rest_length(robot) / 2, min_rest_length);
  const PointGrid grid(robot.masses, reach);
  double sum = 0;
  for (const Vec3& x : robot.masses) sum += std::max(0.0, 1 - grid.distance({x.x, twice_middle - x.y, x.z}) / reach);
  return sum / static_cast<double>(robot.masses.size());
}

}  // namespace mercury
