// SPDX-License-Identifier: Apache-2.0
// Scores over generations: the best, the median and the middle half of the living.
#include "evolution/run_folder/plot.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <limits>
#include <utility>
#include <vector>

#include "mercury/number_text.h"

namespace mercury {
namespace {

// Okabe and Ito's colors, which people with any color vision can distinguish.
constexpr std::string_view best_color = "#d55e00", median_color = "#0072b2", half_color = "#56b4e9";
constexpr std::size_t most_points = 700;  // of a line

using Member = double ScoreSpread::*;

// Generations that are drawn: all of them, or every n-th and the last one.
std::vector<const GenerationSummary*> drawn(std::span<const GenerationSummary> generations) {
  const std::size_t every = generations.size() / most_points + 1;
  std::vector<const GenerationSummary*> chosen;
  for (std::size_t i = 0; i < generations.size(); i += every) chosen.push_back(&generations[i]);
  if ((generations.size() - 1) % every != 0) chosen.push_back(&generations.back());
  return chosen;
}

// The worst score is minus infinity.
bool can_be_drawn(double score) { return std::abs(score) < 1e300; }

Range finite_range(std::span<const GenerationSummary> generations, std::size_t objective, Member member) {
  Range range{std::numeric_limits<double>::infinity(), -std::numeric_limits<double>::infinity()};
  for (const GenerationSummary& generation : generations) {
    const double value = generation.scores[objective].*member;
    if (!can_be_drawn(value)) continue;
    range = {std::min(range.low, value), std::max(range.high, value)};
  }
  return range;
}

// The champions and, unless they lie far below, the lower quartiles.
Range score_range(std::span<const GenerationSummary> generations, std::size_t objective) {
  const Range best = finite_range(generations, objective, &ScoreSpread::highest);
  if (!std::isfinite(best.low)) return {};
  const Range quartile = finite_range(generations, objective, &ScoreSpread::lower_quartile);
  Range range = best;
  if (std::isfinite(quartile.low))
    range.low = std::max(std::min(best.low, quartile.low),
                         best.low - 2 * std::max(best.high - best.low, 0.1 * std::abs(best.low)));
  if (range.low > 0 && range.low < 0.35 * range.high) range.low = 0;
  range = widened(range);
  const double margin = 0.05 * (range.high - range.low);
  return {range.low == 0 ? 0 : range.low - margin, range.high + margin};
}

std::string value_text(double value) {
  char text[40];
  std::snprintf(text, sizeof text, "%.4g", value);
  return text;
}

// Names beside the ends of lines, moved apart where they would overlap.
void draw_labels(Svg& svg, const Box& box, const Scale& y, const ScoreSpread& last) {
  constexpr double distance = 34;
  struct Label {
    std::string_view name;
    double value, at;
    std::string_view color;
  };
  std::vector<Label> labels;
  const auto add = [&](std::string_view name, double value, std::string_view color) {
    if (can_be_drawn(value)) labels.push_back({name, value, std::clamp(y(value), box.y, box.bottom()), color});
  };
  add("best", last.highest, best_color);
  add("median", last.median, median_color);
  if (labels.size() == 2 && labels[1].at - labels[0].at < distance) {
    const double middle = (labels[0].at + labels[1].at) / 2;
    labels[0].at = middle - distance / 2;
    labels[1].at = middle + distance / 2;
  }
  for (const Label& label : labels) {
    svg.text({box.right() + 12, label.at - 7}, label.name, {.size = 12, .color = label.color});
    svg.text({box.right() + 12, label.at + 8}, value_text(label.value), {.color = label.color, .bold = true});
  }
}

}  // namespace

void draw_scores(Svg& svg, const Box& box, const RunHistory& run, std::size_t objective) {
  const std::span<const GenerationSummary> generations = run.generations();
  const double last = std::max<double>(1, static_cast<double>(generations.size()) - 1);
  const Range range = score_range(generations, objective);
  const Scale x{0, last, box.x, box.right()}, y{range.low, range.high, box.bottom(), box.y};
  draw_left_axis(svg, box, y, axis_title(run.settings().evolution.objectives[objective]));
  draw_bottom_axis(svg, box, x, "generation", true);
  svg.text({box.x, box.y - 14}, "the best, the median and the middle half of the living", {.size = 12});
  if (generations.empty()) return;

  const std::vector<const GenerationSummary*> chosen = drawn(generations);
  const auto line = [&](Member member) {
    std::vector<PlotPoint> points;
    for (const GenerationSummary* generation : chosen) {
      const double score = generation->scores[objective].*member;
      points.push_back({x(generation->number), can_be_drawn(score) ? y(score) : std::nan("")});
    }
    return points;
  };
  std::vector<PlotPoint> band = line(&ScoreSpread::upper_quartile), lower = line(&ScoreSpread::lower_quartile);
  band.insert(band.end(), lower.rbegin(), lower.rend());
  for (PlotPoint& point : band) point.y = std::isfinite(point.y) ? std::clamp(point.y, -1e4, 1e4) : 1e4;
  svg.begin_clip({box.x, box.y - 2, box.width + 2, box.height + 2});
  svg.polygon(band, half_color, 0.3);
  svg.polyline(line(&ScoreSpread::median), median_color, 1.8);
  svg.polyline(line(&ScoreSpread::highest), best_color, 2.4);
  svg.end_clip();
  draw_labels(svg, box, y, generations.back().scores[objective]);
}

// The living in the plane of two objectives; those whom no other one beats in both form the front.
namespace {

std::vector<PlotPoint> scores_of_living(const RunHistory& run) {
  std::vector<PlotPoint> scores;
  for (const std::uint64_t id : run.living()) {
    const std::vector<double>& both = run.individuals()[id].assessment.scores;
    if (both.size() == 2 && std::abs(both[0]) < 1e300 && std::abs(both[1]) < 1e300)
      scores.push_back({both[0], both[1]});
  }
  return scores;
}

// From left to right; leaves those who are beaten behind.
std::vector<PlotPoint> front_of(std::vector<PlotPoint> scores) {
  std::ranges::sort(scores, [](PlotPoint a, PlotPoint b) { return a.x != b.x ? a.x > b.x : a.y > b.y; });
  std::vector<PlotPoint> front;
  for (const PlotPoint& point : scores)
    if (front.empty() || point.y > front.back().y) front.push_back(point);
  std::ranges::reverse(front);
  return front;
}

template <class Member>
Range range_of(const std::vector<PlotPoint>& points, Member member) {
  if (points.empty()) return {};
  const auto [low, high] =
      std::ranges::minmax_element(points, [&](PlotPoint a, PlotPoint b) { return a.*member < b.*member; });
  const Range range = widened({(*low).*member, (*high).*member});
  const double margin = 0.06 * (range.high - range.low);
  return {range.low - margin, range.high + margin};
}

}  // namespace

void draw_front(Svg& svg, const Box& box, const RunHistory& run) {
  const std::vector<PlotPoint> living = scores_of_living(run);
  const Range across = range_of(living, &PlotPoint::x), up = range_of(living, &PlotPoint::y);
  const Scale x{across.low, across.high, box.x, box.right()}, y{up.low, up.high, box.bottom(), box.y};
  const std::vector<std::string>& objectives = run.settings().evolution.objectives;
  draw_left_axis(svg, box, y, axis_title(objectives[1]));
  draw_bottom_axis(svg, box, x, axis_title(objectives[0]));
  std::vector<PlotPoint> steps;  // an individual of the front beats all below and left of it
  for (const PlotPoint& point : front_of(living)) {
    if (!steps.empty()) steps.push_back({steps.back().x, y(point.y)});
    steps.push_back({x(point.x), y(point.y)});
  }
  svg.polyline(steps, "#d55e00", 1.4);
  for (const PlotPoint& point : living) svg.circle({x(point.x), y(point.y)}, 3.2, "#56b4e9", "#ffffff");
  for (const PlotPoint& point : front_of(living)) svg.circle({x(point.x), y(point.y)}, 4.6, "#d55e00", "#ffffff");
  svg.text({box.x, box.y - 14}, "the living; nobody beats those of the front in both objectives", {.size = 12});
  svg.text({box.right() + 12, box.y + 6}, "front", {.size = 12, .color = "#d55e00", .bold = true});
  svg.text({box.right() + 12, box.y + 26}, "other living", {.size = 12, .color = "#0072b2"});
}

// The map of elites: a cell per place, its color is the score of the one who lives there.
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

namespace {

constexpr double width = 960, left = 92, right = 138, top = 112, below = 68, gap = 34, bottom = 34;

std::string title_of(const RunHistory& run) {
  const std::filesystem::path folder = std::filesystem::absolute(run.folder()).lexically_normal();
  return (folder.has_filename() ? folder.filename() : folder.parent_path().filename()).string();
}

std::string subtitle_of(const RunHistory& run) {
  const EvolutionSettings& settings = run.settings().evolution;
  const std::size_t done = run.generations().empty() ? 0 : run.generations().size() - 1;
  return settings.algorithm.name + "  \u00b7  population " + with_commas(settings.algorithm.population) +
         "  \u00b7  generation " + with_commas(done) + " of " +
         with_commas(static_cast<std::uint64_t>(settings.generations)) + "  \u00b7  seed " +
         std::to_string(settings.seed);
}

// How many robots did not end well.
std::string footer_of(const RunHistory& run) {
  FateCounts fates;
  for (const GenerationSummary& generation : run.generations()) fates += generation.fates;
  std::string text = with_commas(run.individuals().size()) + " robots were tried";
  constexpr std::pair<Fate, const char*> ends[] = {{Fate::exploded, " exploded"},
                                                   {Fate::overstretched, " were overstretched"},
                                                   {Fate::too_small, " were too small"},
                                                   {Fate::failed, " failed"}};
  for (const auto& [fate, what] : ends)
    if (fates[fate] > 0) text += "; " + with_commas(fates[fate]) + what;
  return text;
}

}  // namespace

std::string progress_plot(const RunHistory& run) {
  const EvolutionSettings& settings = run.settings().evolution;
  const std::size_t objectives = settings.objectives.size();
  const bool has_map = algorithm_of(settings.algorithm).has_map;
  const bool has_front = objectives == 2;
  const double score_height = objectives == 1 ? 340 : 230, front_height = 420;
  const double map_height = settings.algorithm.axes.size() > 1 ? 420 : 90;
  double height = top + static_cast<double>(objectives) * (score_height + below + gap) - gap + bottom;
  if (has_front) height += gap + front_height + below;
  if (has_map) height += gap + map_height + below;

  Svg svg(width, height);
  svg.text({32, 36}, title_of(run), {.size = 22, .color = "#16191d", .bold = true});
  svg.text({32, 62}, subtitle_of(run), {.size = 13});
  Box box{left, top, width - left - right, score_height};
  for (std::size_t i = 0; i < objectives; ++i) {
    draw_scores(svg, box, run, i);
    box.y = box.bottom() + below + gap;
  }
  if (has_front) {
    box.height = front_height;
    draw_front(svg, box, run);
    box.y = box.bottom() + below + gap;
  }
  if (has_map) {
    box.height = map_height;
    draw_map(svg, box, run);
  }
  svg.text({32, height - 22}, footer_of(run), {.size = 12, .color = "#8a9099"});
  return svg.document();
}

}  // namespace mercury
