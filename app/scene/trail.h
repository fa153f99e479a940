// SPDX-License-Identifier: Apache-2.0
// The path of a robot's centre of mass, and the part of it that a picture shows.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "mercury/vec3.h"
#include "render/scene.h"

namespace mercury {

// Keeps at most `most_points`: of a longer path, every second point of the older half is forgotten, so that it still
// begins where it began.
class Trail {
 public:
  static constexpr std::size_t most_points = 2000;

  explicit Trail(Vec3 start = {}) : start_(start), last_(start) {}

  Vec3 start() const { return start_; }  // [m]
  Vec3 last() const { return last_; }    // the last place that pass() was called with [m]

  // Where the robot is now. Places that are not finite are ignored. Keep it up to date also while no path is shown.
  void pass(Vec3 place);
  // Appends the present place to the path if it is at least `step` from the last point [m].
  void lengthen(float step);

  std::span<const float> points() const { return points_; }    // 3 each [m], the oldest first
  std::span<const float> lengths() const { return lengths_; }  // of the path up to each point [m]
  // The newest points, back to the first one that is farther than `reach` from the present place [m].
  std::span<const float> wake(float reach) const;

 private:
  void thin_out();

  Vec3 start_, last_;
  std::vector<float> points_, lengths_;
};

// Short bars across a wake wherever its length passes a multiple of `distance` [m]. `size` of a bar [m]; 6 numbers per
// bar, its two ends.
std::vector<float> marks_of(const Trail& trail, std::span<const float> wake, float distance, float size);

}  // namespace mercury
