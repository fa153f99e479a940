// SPDX-License-Identifier: Apache-2.0
// A race: lanes with a start line and marks, and the order in which robots arrive at the marks.
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "render/scene.h"
#include "render/vector.h"

namespace mercury {

// When each robot passed each mark, in simulated time.
class MarkTimes {
 public:
  // `distance` between marks [m].
  explicit MarkTimes(float distance = 1) : distance_(distance) {}

  // `progress`: of each robot [m]; negative = it takes no part any more. Times between two calls are interpolated;
  // those of marks that were passed before the first call are unknown. Times may go back; then later passings are
  // forgotten.
  void update(double time, std::span<const float> progress);

  float distance() const { return distance_; }
  // The farthest mark that a robot has passed, among multiples of `step` marks; 0 = none.
  std::size_t farthest(std::size_t step = 1) const;
  // The robots that have passed this mark, in the order of their passing, with their times [s]; without those of
  // unknown times.
  struct Passing {
    std::size_t robot = 0;
    double time = 0;
  };
  std::vector<Passing> at(std::size_t mark) const;

 private:
  static constexpr double unknown = -1;
  float distance_;
  double time_ = 0;                         // of the last update [s]
  std::vector<float> before_;               // the progress then
  std::vector<std::vector<double>> times_;  // [robot][mark - 1]
};

// How many marks apart lines are drawn, so that there are at most ten on `length` meters: their distance is 1, 2 or 5
// times a power of ten.
std::size_t marks_per_line(float distance, float length);

// A lane, from its start line on.
struct Lane {
  render::Vector3 start{0, 0, 0};  // in the picture [m]
  float half_width = 0;            // [m]
  float progress = 0;              // of its robot [m]
  render::Color color;
};

// Lines and numbers of a race, in the picture's coordinates.
class Course {
 public:
  // `along`: the direction of the lanes, level, of length 1; `height` of the lines [m]; `step`: marks per line.
  void draw(std::span<const Lane> lanes, const render::Vector3& along, float height, const MarkTimes& passings,
            std::size_t step, render::Theme theme);
  std::span<const render::Path> lines() const { return lines_; }
  std::span<const render::Text> numbers() const { return numbers_; }

 private:
  void add(const render::Vector3& from, const render::Vector3& to, render::Color color);

  std::vector<std::vector<float>> points_;
  std::vector<render::Path> lines_;
  std::vector<render::Text> numbers_;
};

// "order at 3 m" and a line for each of the first robots there: "1. eel, 24.1 s"; empty before the first passing.
std::string order_text(const MarkTimes& passings, std::size_t step, std::span<const std::string> names);

}  // namespace mercury
