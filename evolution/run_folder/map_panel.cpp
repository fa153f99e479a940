// SPDX-License-Identifier: Apache-2.0
// The map of elites: a cell per place, its color is the score of the one who lives there.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <limits>
#include <vector>

#include "evolution/run_folder/plot_axes.h"
#include "evolution/run_folder/progress_plot.h"

namespace mercury {
namespace {

constexpr double empty = -std::numeric_limits<double>::infinity();
constexpr std::string_view empty_color = "#f1f2f4";

// Viridis (van der Walt and Smith), at equal distances: even in brightness, also for people who are color-blind.
constexpr std::array<std::array<int, 3>, 9> viridis{{{68, 1, 84},
                                                     {71, 44, 122},
                                                     {59, 81, 139},
                                                     {44, 113, 142},
                                                     {33, 144, 141},
                                                     {39, 173, 129},
                                                     {92, 200, 99},
                                                     {170, 220, 50},
                                                     {253, 231, 37}}};

std::string color_of(double share) {
  const double position = std::clamp(share, 0.0, 1.0) * (viridis.size() - 1);
  const auto below = std::min(static_cast<std::size_t>(position), viridis.size() - 2);
  const double rest = position - static_cast<double>(below);
  std::array<int, 3> mixed{};
  for (std::size_t i = 0; i < 3; ++i)
    mixed[i] = static_cast<int>(std::lround(viridis[below][i] + rest * (viridis[below + 1][i] - viridis[below][i])));
  char text[8];
  std::snprintf(text, sizeof text, "#%02x%02x%02x", mixed[0] & 0xff, mixed[1] & 0xff, mixed[2] & 0xff);
  return text;
}

constexpr std::size_t most_drawn = 150;  // columns or rows; cells of larger maps are drawn together

// The best score per drawn cell of the first two axes; of further axes the best.
struct Map {
  std::size_t columns = 1, rows = 1;
  std::vector<double> best;
  std::size_t living = 0;  // each in a cell of its own
  Range range{std::numeric_limits<double>::infinity(), empty};
};

Map map_of(const RunHistory& run) {
  const std::vector<MapAxis>& axes = run.settings().evolution.algorithm.axes;
  const auto cells = [&](std::size_t axis) {
    return axis < axes.size() ? static_cast<std::size_t>(axes[axis].cells) : std::size_t{1};
  };
  Map map;
  map.columns = std::min(cells(0), most_drawn);
  map.rows = std::min(cells(1), most_drawn);
  map.best.assign(map.columns * map.rows, empty);
  for (const std::uint64_t id : run.living()) {
    const Individual& individual = run.individuals()[id];
    if (individual.assessment.values.empty() || !(std::abs(individual.score()) < 1e300)) continue;
    const std::size_t cell = map_cell(axes, individual.assessment.values);
    const std::size_t column = cell % cells(0) * map.columns / cells(0);
    const std::size_t row = cell / cells(0) % cells(1) * map.rows / cells(1);
    double& best = map.best[row * map.columns + column];
    best = std::max(best, individual.score());
    map.range = {std::min(map.range.low, individual.score()), std::max(map.range.high, individual.score())};
    ++map.living;
  }
  map.range = map.living > 0 ? widened(map.range) : Range{};
  return map;
}

void draw_color_bar(Svg& svg, const Box& box, const Range& range, const std::string& title) {
  constexpr int steps = 64;
  const Scale scale{range.low, range.high, box.bottom(), box.y};
  for (int i = 0; i < steps; ++i) {
    const double top = box.bottom() - box.height * (i + 1) / steps;
    svg.rectangle({box.x, top, box.width, box.height / steps + 0.5}, color_of((i + 0.5) / steps));
  }
  const std::vector<double> ticks = ticks_in(range, std::max(2, static_cast<int>(box.height / 60)));
  const double step = ticks.size() > 1 ? ticks[1] - ticks[0] : range.high - range.low;
  for (const double tick : ticks) svg.text({box.right() + 8, scale(tick)}, tick_text(tick, step), {.size = 12});
  svg.text({box.x, box.y - 14}, title, {.size = 12, .color = "#33373d"});
}

}  // namespace

void draw_map(Svg& svg, const Box& box, const RunHistory& run) {
  const std::vector<MapAxis>& axes = run.settings().evolution.algorithm.axes;
  const Map map = map_of(run);
  std::uint64_t all = 1;
  for (const MapAxis& axis : axes) all *= static_cast<std::uint64_t>(axis.cells);
  const double width = box.width / static_cast<double>(map.columns);
  const double height = box.height / static_cast<double>(map.rows);
  const double seam = std::min(width, height) > 6 ? 1 : 0;  // between cells
  svg.text({box.x, box.y - 14}, with_commas(map.living) + " of " + with_commas(all) + " cells are filled",
           {.size = 12});
  const Scale x{axes[0].lowest, axes[0].highest, box.x, box.right()};
  if (axes.size() > 1)
    draw_left_axis(svg, box, {axes[1].lowest, axes[1].highest, box.bottom(), box.y}, axis_title(axes[1].quantity));
  draw_bottom_axis(svg, box, x, axis_title(axes[0].quantity));
  for (std::size_t i = 0; i < map.best.size(); ++i) {
    const auto column = static_cast<double>(i % map.columns), row = static_cast<double>(i / map.columns);
    const double share = (map.best[i] - map.range.low) / (map.range.high - map.range.low);
    svg.rectangle({box.x + column * width, box.bottom() - (row + 1) * height, width - seam, height - seam},
                  map.best[i] == empty ? empty_color : color_of(share));
  }
  draw_color_bar(svg, {box.right() + 24, box.y, 16, box.height}, map.range,
                 axis_title(run.settings().evolution.objectives[0]));
}

}  // namespace mercury
