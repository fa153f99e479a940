// SPDX-License-Identifier: Apache-2.0
#include "app/commands/run_board.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <span>

#include "mercury/error.h"
#include "mercury/quantity.h"

namespace mercury {
namespace {

// "size [m3]"; underscores of the name become spaces.
std::string title_of(const std::string& quantity) {
  std::string title = quantity;
  std::ranges::replace(title, '_', ' ');
  const auto found = find_quantity(quantity);
  const std::string_view unit = found ? quantities()[*found].unit : "";
  return unit.empty() ? title : fmt::format("{} [{}]", title, unit);
}

// With as few digits as write multiples of `step` exactly, or two that count if that takes more than 3.
std::string tick_of(double value, double step) {
  const auto is_whole = [](double x) { return std::abs(x - std::round(x)) < 1e-6; };
  int digits = 0;
  while (digits < 4 && !is_whole(step * std::pow(10, digits))) ++digits;
  if (digits > 3) digits = std::max(0, 1 - static_cast<int>(std::floor(std::log10(step))));
  return fmt::format("{:.{}f}", std::abs(value) < 1e-9 * step ? 0 : value, digits);
}

BoardAxis axis_of(const MapAxis& axis) {
  constexpr int most_ticks = 11;
  BoardAxis shown{.title = title_of(axis.quantity)};
  const int every = 1 + axis.cells / most_ticks;
  const double width = (axis.highest - axis.lowest) / axis.cells;
  for (int i = 0; i <= axis.cells; ++i)
    shown.ticks.push_back(i % every != 0 ? "" : tick_of(axis.lowest + i * width, every * width));
  return shown;
}

render::Legend legend_of(const RunSettings& settings, std::span<const std::optional<float>> values) {
  const std::string& objective = settings.evolution.objectives.front();
  const auto quantity = find_quantity(objective);
  render::Scale scale{.low = 1e30f, .high = -1e30f, .map = render::Colormap::viridis};
  for (const std::optional<float>& value : values) {
    if (!value) continue;
    scale.low = std::min(scale.low, *value);
    scale.high = std::max(scale.high, *value);
  }
  if (!(scale.low < scale.high)) scale = {.low = scale.low - 0.5f, .high = scale.low + 0.5f, .map = scale.map};
  return {.title = quantity ? objective : "score",
          .unit = std::string(quantity ? quantities()[*quantity].unit : ""),
          .scale = scale};
}

}  // namespace

RunBoard board_of(const RunHistory& run) {
  const RunSettings& settings = run.settings();
  const std::vector<MapAxis>& axes = settings.evolution.algorithm.axes;
  if (settings.evolution.algorithm.name != "map-elites" || axes.empty())
    throw InputError(run.folder().string(),
                     fmt::format("has no map, since its algorithm is {}; --map takes runs of map-elites",
                                 settings.evolution.algorithm.name));
  const auto drawn = std::span(axes).first(std::min<std::size_t>(2, axes.size()));
  const auto columns = static_cast<std::size_t>(axes[0].cells),
             rows = static_cast<std::size_t>(drawn.size() > 1 ? axes[1].cells : 1);
  auto board = std::make_shared<Board>();
  board->grid = {static_cast<int>(columns), static_cast<int>(rows)};
  board->values.resize(columns * rows);
  board->across = axis_of(axes[0]);
  if (drawn.size() > 1) board->upward = axis_of(axes[1]);
  RunBoard map;
  std::map<std::size_t, std::uint64_t> best;  // by cell
  for (const std::uint64_t id : run.living()) {
    const Individual& individual = run.individuals()[static_cast<std::size_t>(id)];
    const Assessment& assessment = individual.assessment;
    if (assessment.values.empty() || !(individual.score() > worst_score)) continue;
    const std::size_t cell = map_cell(drawn, assessment.values);
    const std::size_t place =
        (rows - 1 - cell / columns) * columns + cell % columns;  // the highest row is the upper one
    const auto score = static_cast<float>(individual.score());
    if (board->values[place] && *board->values[place] >= score) continue;
    board->values[place] = score;
    best[place] = id;
  }
  for (const auto& [cell, id] : best) {
    board->cell_of.push_back(cell);
    map.robots.push_back(id);
  }
  if (map.robots.empty()) throw InputError(run.folder().string(), "has no robot with a score in its map");
  board->legend = legend_of(settings, board->values);
  if (axes.size() > 2)
    map.notes.push_back(
        fmt::format("the map has {} axes; drawn by the first two, with the best robot of each cell", axes.size()));
  map.board = std::move(board);
  return map;
}

}  // namespace mercury
