// SPDX-License-Identifier: Apache-2.0
// The living in the plane of two objectives; those whom no other one beats in both form the front.
#include <algorithm>
#include <cmath>
#include <vector>

#include "evolution/run_folder/plot_axes.h"
#include "evolution/run_folder/progress_plot.h"

namespace mercury {
namespace {

std::vector<Point> scores_of_living(const RunHistory& run) {
  std::vector<Point> scores;
  for (const std::uint64_t id : run.living()) {
    const std::vector<double>& both = run.individuals()[id].assessment.scores;
    if (both.size() == 2 && std::abs(both[0]) < 1e300 && std::abs(both[1]) < 1e300)
      scores.push_back({both[0], both[1]});
  }
  return scores;
}

// From left to right; leaves those who are beaten behind.
std::vector<Point> front_of(std::vector<Point> scores) {
  std::ranges::sort(scores, [](Point a, Point b) { return a.x != b.x ? a.x > b.x : a.y > b.y; });
  std::vector<Point> front;
  for (const Point& point : scores)
    if (front.empty() || point.y > front.back().y) front.push_back(point);
  std::ranges::reverse(front);
  return front;
}

template <class Member>
Range range_of(const std::vector<Point>& points, Member member) {
  if (points.empty()) return {};
  const auto [low, high] = std::ranges::minmax_element(points, [&](Point a, Point b) { return a.*member < b.*member; });
  const Range range = widened({(*low).*member, (*high).*member});
  const double margin = 0.06 * (range.high - range.low);
  return {range.low - margin, range.high + margin};
}

}  // namespace

void draw_front(Svg& svg, const Box& box, const RunHistory& run) {
  const std::vector<Point> living = scores_of_living(run);
  const Range across = range_of(living, &Point::x), up = range_of(living, &Point::y);
  const Scale x{across.low, across.high, box.x, box.right()}, y{up.low, up.high, box.bottom(), box.y};
  const std::vector<std::string>& objectives = run.settings().evolution.objectives;
  draw_left_axis(svg, box, y, axis_title(objectives[1]));
  draw_bottom_axis(svg, box, x, axis_title(objectives[0]));
  std::vector<Point> steps;  // an individual of the front beats all below and left of it
  for (const Point& point : front_of(living)) {
    if (!steps.empty()) steps.push_back({steps.back().x, y(point.y)});
    steps.push_back({x(point.x), y(point.y)});
  }
  svg.polyline(steps, "#d55e00", 1.4);
  for (const Point& point : living) svg.circle({x(point.x), y(point.y)}, 3.2, "#56b4e9", "#ffffff");
  for (const Point& point : front_of(living)) svg.circle({x(point.x), y(point.y)}, 4.6, "#d55e00", "#ffffff");
  svg.text({box.x, box.y - 14}, "the living; nobody beats those of the front in both objectives", {.size = 12});
  svg.text({box.right() + 12, box.y + 6}, "front", {.size = 12, .color = "#d55e00", .bold = true});
  svg.text({box.right() + 12, box.y + 26}, "other living", {.size = 12, .color = "#0072b2"});
}

}  // namespace mercury
