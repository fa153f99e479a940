// SPDX-License-Identifier: Apache-2.0
#include "app/scene/trail.h"

#include <algorithm>
#include <cmath>

#include "render/vector.h"

namespace mercury {
namespace {

render::Vector3 point_at(std::span<const float> points, std::size_t i) {
  return {points[3 * i], points[3 * i + 1], points[3 * i + 2]};
}

}  // namespace

void Trail::pass(Vec3 place) {
  if (render::Vector3(place).is_finite()) last_ = place;
}

void Trail::lengthen(float step, double time, Later later) {
  const bool jumps = later == Later::skip && time > known_until_;
  if (jumps || (!times_.empty() && time < times_.front())) cut(0);
  const auto until = [&](double end) {
    return static_cast<std::size_t>(std::ranges::upper_bound(times_, end) - times_.begin());
  };
  if (later == Later::forget) cut(until(std::min(now_, time)));
  now_ = time;
  shown_ = until(time);
  if (shown_ < times_.size()) return;
  known_until_ = later == Later::forget || shown_ == 0 ? time : std::max(known_until_, time);
  const float moved = shown_ == 0 ? 0 : (render::Vector3(last_) - point_at(points_, shown_ - 1)).norm();
  if (shown_ > 0 && (moved == 0 || moved < step)) return;
  points_.insert(points_.end(), {last_.x, last_.y, last_.z});
  lengths_.push_back(shown_ == 0 ? 0 : lengths_.back() + moved);
  times_.push_back(time);
  if (times_.size() > most_points) thin_out();
  shown_ = times_.size();
}

void Trail::cut(std::size_t count) {
  points_.resize(3 * count);
  lengths_.resize(count);
  times_.resize(count);
}

void Trail::thin_out() {
  std::size_t kept = 0;
  for (std::size_t i = 0; i < lengths_.size(); ++i) {
    if (i < most_points / 2 && i % 2 == 1) continue;
    for (std::size_t axis = 0; axis < 3; ++axis) points_[3 * kept + axis] = points_[3 * i + axis];
    times_[kept] = times_[i];
    lengths_[kept++] = lengths_[i];
  }
  cut(kept);
}

std::span<const float> Trail::wake(float reach) const {
  std::size_t first = shown_;
  while (first > 0 && (point_at(points_, first - 1) - render::Vector3(last_)).norm() <= reach) --first;
  return points().subspan(3 * first);
}

std::vector<float> marks_of(const Trail& trail, std::span<const float> wake, float distance, float size) {
  std::vector<float> bars;
  const std::size_t all = trail.lengths().size(), first = all - wake.size() / 3;
  for (std::size_t i = first + 1; i < all; ++i) {
    const float before = trail.lengths()[i - 1], after = trail.lengths()[i];
    const float mark = distance * std::floor(after / distance);
    if (mark <= before) continue;
    const render::Vector3 a = point_at(trail.points(), i - 1), b = point_at(trail.points(), i);
    const render::Vector3 at = a + (mark - before) / (after - before) * (b - a), along = (b - a).normalized();
    // Two bars across the path, so that one is seen from every side.
    const render::Vector3 level =
        std::abs(along.z) < 0.99f ? along.cross(render::Vector3::unit(2)).normalized() : render::Vector3::unit(0);
    for (const render::Vector3& across : {level, render::Vector3(level.cross(along))})
      for (const float side : {-0.5f, 0.5f}) {
        const render::Vector3 end = at + side * size * across;
        bars.insert(bars.end(), {end.x, end.y, end.z});
      }
  }
  return bars;
}

}  // namespace mercury
