// SPDX-License-Identifier: Apache-2.0
// Scores over generations: the best, the median and the middle half of the living.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>

#include "evolution/run_folder/plot_axes.h"
#include "evolution/run_folder/progress_plot.h"

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
    std::vector<Point> points;
    for (const GenerationSummary* generation : chosen) {
      const double score = generation->scores[objective].*member;
      points.push_back({x(generation->number), can_be_drawn(score) ? y(score) : std::nan("")});
    }
    return points;
  };
  std::vector<Point> band = line(&ScoreSpread::upper_quartile), lower = line(&ScoreSpread::lower_quartile);
  band.insert(band.end(), lower.rbegin(), lower.rend());
  for (Point& point : band) point.y = std::isfinite(point.y) ? std::clamp(point.y, -1e4, 1e4) : 1e4;
  svg.begin_clip({box.x, box.y - 2, box.width + 2, box.height + 2});
  svg.polygon(band, half_color, 0.3);
  svg.polyline(line(&ScoreSpread::median), median_color, 1.8);
  svg.polyline(line(&ScoreSpread::highest), best_color, 2.4);
  svg.end_clip();
  draw_labels(svg, box, y, generations.back().scores[objective]);
}

}  // namespace mercury
