// SPDX-License-Identifier: Apache-2.0
#include "app/scene/trail.h"

#include <Eigen/Core>
#include <Eigen/Geometry>

#include <cmath>

#include "app/scene/eigen_vec3.h"

namespace mercury {
namespace {

Eigen::Vector3f point_at(std::span<const float> points, std::size_t i) {
  return {points[3 * i], points[3 * i + 1], points[3 * i + 2]};
}

}  // namespace

void Trail::pass(Vec3 place) {
  if (eigen(place).allFinite()) last_ = place;
}

void Trail::lengthen(float step) {
  const std::size_t count = lengths_.size();
  if (count == 0) {
    points_ = {last_.x, last_.y, last_.z};
    lengths_ = {0};
    return;
  }
  const float moved = (eigen(last_) - point_at(points_, count - 1)).norm();
  if (moved == 0 || moved < step) return;
  points_.insert(points_.end(), {last_.x, last_.y, last_.z});
  lengths_.push_back(lengths_.back() + moved);
  if (lengths_.size() > most_points) thin_out();
}

void Trail::thin_out() {
  std::size_t kept = 0;
  for (std::size_t i = 0; i < lengths_.size(); ++i) {
    if (i < most_points / 2 && i % 2 == 1) continue;
    for (std::size_t axis = 0; axis < 3; ++axis) points_[3 * kept + axis] = points_[3 * i + axis];
    lengths_[kept++] = lengths_[i];
  }
  points_.resize(3 * kept);
  lengths_.resize(kept);
}

std::span<const float> Trail::wake(float reach) const {
  std::size_t first = lengths_.size();
  while (first > 0 && (point_at(points_, first - 1) - eigen(last_)).norm() <= reach) --first;
  return std::span(points_).subspan(3 * first);
}

std::vector<float> marks_of(const Trail& trail, std::span<const float> wake, float distance, float size) {
  std::vector<float> bars;
  const std::size_t all = trail.lengths().size(), first = all - wake.size() / 3;
  for (std::size_t i = first + 1; i < all; ++i) {
    const float before = trail.lengths()[i - 1], after = trail.lengths()[i];
    const float mark = distance * std::floor(after / distance);
    if (mark <= before) continue;
    const Eigen::Vector3f a = point_at(trail.points(), i - 1), b = point_at(trail.points(), i);
    const Eigen::Vector3f at = a + (mark - before) / (after - before) * (b - a), along = (b - a).normalized();
    // Two bars across the path, so that one is seen from every side.
    const Eigen::Vector3f level =
        std::abs(along.z()) < 0.99f ? along.cross(Eigen::Vector3f::UnitZ()).normalized() : Eigen::Vector3f::UnitX();
    for (const Eigen::Vector3f& across : {level, Eigen::Vector3f(level.cross(along))})
      for (const float side : {-0.5f, 0.5f}) {
        const Eigen::Vector3f end = at + side * size * across;
        bars.insert(bars.end(), {end.x(), end.y(), end.z()});
      }
  }
  return bars;
}

}  // namespace mercury
