// SPDX-License-Identifier: Apache-2.0
// The path of a robot's center of mass, and the part of it that a picture shows.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "mercury/vec3.h"
#include "render/scene.h"

namespace mercury {

// What a picture shows of the past when time goes back to an earlier moment.
enum class Later {
  forget,  // what came after it has not happened
  keep,    // it is hidden until time has come so far again
  skip     // the same, and if time jumps past all known points, the path begins there
};

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
  // It is `time` [s]. Appends the current place to the path if it is at least `step` from the last point [m]. If time
  // went back, the path ends where the robot was then.
  void lengthen(float step, double time, Later later = Later::forget);

  // The path up to the present: points, 3 numbers each [m], the oldest first; and its length up to each of them [m].
  std::span<const float> points() const { return std::span(points_).first(3 * shown_); }
  std::span<const float> lengths() const { return std::span(lengths_).first(shown_); }
  // The newest points, back to the first one that is farther than `reach` from the current place [m].
  std::span<const float> wake(float reach) const;

 private:
  void thin_out();
  void cut(std::size_t count);

  Vec3 start_, last_;
  std::vector<float> points_, lengths_;
  std::vector<double> times_;  // of the points, ascending [s]
  double now_ = 0;             // the time of the last lengthen() [s]
  double known_until_ = 0;     // the last time of lengthen(), without those that were forgotten [s]
  std::size_t shown_ = 0;      // points up to the present
};

// Short bars across a wake wherever its length passes a multiple of `distance` [m]. `size` of a bar [m]; 6 numbers per
// bar, its two ends.
std::vector<float> marks_of(const Trail& trail, std::span<const float> wake, float distance, float size);

}  // namespace mercury
