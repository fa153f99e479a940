// SPDX-License-Identifier: Apache-2.0
#include "app/commands/sweep.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <system_error>
#include <utility>

#include "app/base/output_files.h"
#include "evolution/run_folder/plot.h"
#include "mercury/run_folder.h"
#include "mercury/spread.h"

namespace mercury {
namespace {

namespace fs = std::filesystem;

// Okabe and Ito's colors, which people with any color vision can distinguish.
constexpr std::array colors{"#0072b2", "#d55e00", "#009e73", "#cc79a7", "#e69f00", "#56b4e9", "#000000"};

std::vector<fs::path> folders_in(const fs::path& folder) {
  std::vector<fs::path> folders;
  std::error_code error;
  for (fs::directory_iterator entry(folder, error), end; !error && entry != end; entry.increment(error))
    if (entry->is_directory(error)) folders.push_back(entry->path());
  std::ranges::sort(folders);
  return folders;
}

SweptRun read_run(const fs::path& folder, std::string& objective) {
  const RunHistory history(folder);
  const EvolutionSettings& settings = history.settings().evolution;
  if (objective.empty()) objective = settings.objectives.front();
  SweptRun run{.seed = settings.seed, .folder = folder, .tried = {}, .best = {}};
  std::size_t tried = 0;
  for (const GenerationSummary& generation : history.generations()) {
    run.tried.push_back(tried += generation.born);
    run.best.push_back(generation.scores.front().highest);
  }
  run.done = static_cast<int>(run.best.size()) > settings.generations;
  return run;
}

// Of the runs that have generations.
std::vector<double> last_scores(const SweepVariant& variant) {
  std::vector<double> scores;
  for (const SweptRun& run : variant.runs)
    if (!run.best.empty()) scores.push_back(run.best.back());
  return scores;
}

bool can_be_drawn(double score) { return std::abs(score) < 1e300; }

// Of a variant after each generation that all its begun runs have.
struct Curve {
  std::vector<std::size_t> tried;
  std::vector<Spread> best;
};

Curve curve_of(const SweepVariant& variant) {
  std::size_t generations = std::numeric_limits<std::size_t>::max();
  const SweptRun* first = nullptr;
  for (const SweptRun& run : variant.runs)
    if (!run.best.empty()) {
      generations = std::min(generations, run.best.size());
      if (!first) first = &run;
    }
  Curve curve;
  if (!first) return curve;
  for (std::size_t g = 0; g < generations; ++g) {
    std::vector<double> scores;
    for (const SweptRun& run : variant.runs)
      if (!run.best.empty() && can_be_drawn(run.best[g])) scores.push_back(run.best[g]);
    curve.tried.push_back(first->tried[g]);
    curve.best.push_back(spread_of(std::move(scores)));
  }
  return curve;
}

void draw_curve(Svg& svg, const Curve& curve, const Scale& x, const Scale& y, std::string_view color) {
  std::vector<PlotPoint> middle, upper, lower;
  for (std::size_t i = 0; i < curve.tried.size(); ++i) {
    const Spread& best = curve.best[i];
    if (!std::isfinite(best.median)) continue;
    const double at = x(static_cast<double>(curve.tried[i]));
    middle.push_back({at, y(best.median)});
    upper.push_back({at, y(best.upper_quartile)});
    lower.push_back({at, y(best.lower_quartile)});
  }
  upper.insert(upper.end(), lower.rbegin(), lower.rend());
  svg.polygon(upper, color, 0.15);
  svg.polyline(middle, color, 2.2);
}

}  // namespace

std::vector<fs::path> runs_of_sweep(const fs::path& folder) {
  std::vector<fs::path> runs;
  if (is_run_folder(folder)) return runs;
  for (const fs::path& variant : folders_in(folder))
    for (const fs::path& run : folders_in(variant))
      if (is_run_folder(run)) runs.push_back(run);
  return runs;
}

Sweep read_sweep(const fs::path& folder) {
  Sweep sweep;
  for (const fs::path& run : runs_of_sweep(folder)) {
    const std::string name = run.parent_path().filename().string();
    if (sweep.empty() || sweep.variants.back().name != name) sweep.variants.push_back({.name = name, .runs = {}});
    sweep.variants.back().runs.push_back(read_run(run, sweep.objective));
  }
  for (SweepVariant& variant : sweep.variants) std::ranges::stable_sort(variant.runs, {}, &SweptRun::seed);
  return sweep;
}

std::string sweep_csv(const Sweep& sweep) {
  CsvLines lines;
  for (const char* name : {"variant", "seed", "generation", "robots", "best"}) lines.cell(name);
  lines.end_line();
  for (const SweepVariant& variant : sweep.variants)
    for (const SweptRun& run : variant.runs) {
      if (run.best.empty()) continue;
      const double best = run.best.back();
      lines.cell(variant.name).cell(run.seed).cell(run.best.size() - 1).cell(run.tried.back());
      lines.cell(can_be_drawn(best) ? csv_number(best) : "").end_line();
    }
  return lines.text();
}

std::string sweep_plot(const Sweep& sweep) {
  constexpr double width = 900, height = 520, row = 20;
  const Box box{90, 84, width - 90 - 40, height - 84 - 60 - row * static_cast<double>(sweep.variants.size())};
  std::vector<Curve> curves;
  Range range{std::numeric_limits<double>::infinity(), -std::numeric_limits<double>::infinity()};
  std::size_t most = 1;
  for (const SweepVariant& variant : sweep.variants) {
    const Curve& curve = curves.emplace_back(curve_of(variant));
    for (const Spread& best : curve.best) {
      if (!std::isfinite(best.median)) continue;
      range = {std::min(range.low, best.lower_quartile), std::max(range.high, best.upper_quartile)};
    }
    if (!curve.tried.empty()) most = std::max(most, curve.tried.back());
  }
  range = std::isfinite(range.low) ? widened(range) : Range{};
  range.high += 0.05 * (range.high - range.low);
  const Scale x{0, static_cast<double>(most), box.x, box.right()}, y{range.low, range.high, box.bottom(), box.y};
  Svg svg(width, height);
  svg.text({32, 36}, "Sweep", {.size = 22, .color = "#16191d", .bold = true});
  svg.text({32, 60}, "best score: the median and the middle half of the runs", {.size = 13});
  draw_left_axis(svg, box, y, axis_title(sweep.objective));
  draw_bottom_axis(svg, box, x, "robots tried", true);
  svg.begin_clip(box);
  for (std::size_t i = 0; i < curves.size(); ++i) draw_curve(svg, curves[i], x, y, colors[i % colors.size()]);
  svg.end_clip();
  double at = box.bottom() + 62;
  for (std::size_t i = 0; i < curves.size(); ++i, at += row) {
    svg.line({box.x, at}, {box.x + 24, at}, colors[i % colors.size()], 3);
    svg.text({box.x + 34, at}, sweep.variants[i].name, {.size = 13});
  }
  return svg.document();
}

std::string sweep_table(const Sweep& sweep) {
  std::size_t wide = 7;
  for (const SweepVariant& variant : sweep.variants) wide = std::max(wide, variant.name.size());
  std::string text = fmt::format("{:<{}}  runs  {:>10}  {:>22}", "variant", wide, "median", "quartiles");
  const std::vector<double> first = sweep.empty() ? std::vector<double>() : last_scores(sweep.variants.front());
  const bool compares = sweep.variants.size() > 1;
  text += compares ? fmt::format("  p against {}\n", sweep.variants.front().name) : "\n";
  for (const SweepVariant& variant : sweep.variants) {
    const std::vector<double> scores = last_scores(variant);
    const Spread spread = spread_of(scores);
    text += fmt::format("{:<{}}  {:>4}  {:>10.5g}  {:>22}", variant.name, wide, scores.size(), spread.median,
                        fmt::format("{:.5g} to {:.5g}", spread.lower_quartile, spread.upper_quartile));
    text +=
        compares && &variant != &sweep.variants.front() ? fmt::format("  {:.2g}\n", rank_test(first, scores)) : "\n";
  }
  return text;
}

}  // namespace mercury
