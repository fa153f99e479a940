// SPDX-License-Identifier: Apache-2.0
#include "evolution/run_folder/progress_plot.h"

#include <filesystem>

#include "evolution/run_folder/plot_axes.h"

namespace mercury {
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
  std::uint64_t exploded = 0, overstretched = 0, failed = 0;
  for (const GenerationSummary& generation : run.generations()) {
    exploded += generation.exploded;
    overstretched += generation.overstretched;
    failed += generation.failed;
  }
  std::string text = with_commas(run.individuals().size()) + " robots were tried";
  if (exploded > 0) text += "; " + with_commas(exploded) + " exploded";
  if (overstretched > 0) text += "; " + with_commas(overstretched) + " were overstretched";
  if (failed > 0) text += "; " + with_commas(failed) + " failed";
  return text;
}

}  // namespace

std::string progress_plot(const RunHistory& run) {
  const EvolutionSettings& settings = run.settings().evolution;
  const std::size_t objectives = settings.objectives.size();
  const bool has_map = settings.algorithm.name == "map-elites" && !settings.algorithm.axes.empty();
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
