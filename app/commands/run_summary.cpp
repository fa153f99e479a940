// SPDX-License-Identifier: Apache-2.0
// mercury info RUN: what an evolution looks for, and what it has found so far.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <filesystem>

#include "app/base/progress.h"
#include "app/commands/description.h"
#include "app/commands/run_film.h"
#include "app/options/generator_options.h"
#include "mercury/custom.h"
#include "mercury/host_memory.h"
#include "mercury/names.h"
#include "mercury/number_text.h"
#include "mercury/quantity.h"

namespace mercury {
namespace {

// "12,345 robots"
std::string counted(std::size_t number, const char* one, const char* many) {
  return fmt::format("{} {}", with_commas(number), number == 1 ? one : many);
}

// "voxel robots, --size 6x4x4, their bodies", or "what the user gave"
std::string genome_text(const GenomeSpaceRequest& space) {
  std::string text;
  if (!space.founders.empty()) {
    text = "from " + counted(space.founders.size(), "given robot", "given robots");
  } else {
    const Generator* generator = find_generator(space.kind);
    text = space.kind + " robots";
    if (is_custom(space.kind)) return text + ", which a program makes";
    if (generator)
      for (const auto& [option, value] : options_of(*generator, space.values))
        text += fmt::format(", {} {}", option.substr(2), value);
  }
  std::vector<std::string> genes;
  for (const Genes gene : {Genes::body, Genes::muscles, Genes::brain})
    if (contains(space.genes, gene)) genes.push_back(name_of(gene));
  text += "; what changes: " + list_of(genes, " and ");
  if (space.growth.brain_growth) text += "; brains grow";
  if (space.muscles.muscle_adaptation) text += "; steps of muscles adapt themselves";
  if (space.muscles.muscle_tail > 0)
    text += fmt::format("; steps of muscles from Student's t, {} degrees of freedom", space.muscles.muscle_tail);
  return text;
}

std::string trials_text(const TrialSettings& trials) {
  std::string text = fmt::format("{} of {:g} s", trials.trials, trials.seconds);
  if (trials.settle > 0) text += fmt::format(", the first {:g} s not measured", trials.settle);
  if (trials.jitter > 0) text += fmt::format(", jitter {:g}", trials.jitter);
  if (trials.trials > 1 && trials.delay > 0) text += fmt::format(", started up to {:g} s later", trials.delay);
  if (trials.noise > 0) text += fmt::format(", noise {:g}", trials.noise);
  if (trials.damage > 0) text += fmt::format(", damage {:g}", trials.damage);
  if (trials.trials > 1) text += trials.median && !trials.mean ? ", the median counts" : ", the mean counts";
  if (trials.target_radius > 0)
    text += fmt::format(", {:g} m from the target", trials.target_radius * (1 - trials.target_spread)) +
            (trials.target_spread > 0 ? fmt::format(" to {:g} m", trials.target_radius) : "");
  if (trials.turned) text += ", turned at random";
  text += fmt::format(", strain limit {:g}", trials.strain_limit);
  return text + (trials.racing ? ", racing" : "");
}

std::string algorithm_text(const EvolutionSettings& settings) {
  const AlgorithmSettings& algorithm = settings.algorithm;
  const std::size_t children = settings.children > 0 ? settings.children : algorithm.population;
  std::string text = algorithm.name;
  const AlgorithmDescription& description = algorithm_of(algorithm);
  if (!description.has_map) text += fmt::format(", population {}", algorithm.population);
  if (is_custom(algorithm.name))
    text += fmt::format(", seed {}", settings.seed);
  else
    text += fmt::format(", {} children per generation, crossover {:g}, mutation {:g}, seed {}", children,
                        algorithm.crossover, settings.mutation, settings.seed);
  if (algorithm.islands > 1) {
    text += fmt::format("; {} islands", algorithm.islands);
    text +=
        algorithm.migration_interval == 0
            ? ", no migration"
            : fmt::format(", {} from each to the next every {}", counted(algorithm.migrants, "robot", "robots"),
                          counted(static_cast<std::size_t>(algorithm.migration_interval), "generation", "generations"));
  }
  if (!description.of_behavior) return text;
  const bool is_grid = description.has_map && algorithm.niches == 0;
  for (const MapAxis& axis : algorithm.axes) {
    text += fmt::format("; {} {:g} to {:g}", axis.quantity, axis.lowest, axis.highest);
    if (is_grid) text += fmt::format(" in {} cells", axis.cells);
  }
  if (description.has_map && !is_grid) text += fmt::format("; {} niches", algorithm.niches);
  return text;
}

struct Totals {
  std::size_t born = 0;
  FateCounts fates;
  double seconds = 0;
  std::vector<std::string> devices;
};

Totals totals_of(const RunHistory& run) {
  Totals totals;
  for (const GenerationSummary& generation : run.generations()) {
    totals.born += generation.born;
    totals.fates += generation.fates;
    totals.seconds += generation.times.seconds;
    const std::string& device = generation.times.device;
    if (!device.empty() && std::ranges::find(totals.devices, device) == totals.devices.end())
      totals.devices.push_back(device);
  }
  return totals;
}

std::string individuals_text(const RunHistory& run, const Totals& totals) {
  std::string text = fmt::format("{}, of which {} live", with_commas(totals.born), with_commas(run.living().size()));
  std::string separator = "; ";
  for (const Fate fate :
       {Fate::stopped, Fate::exploded, Fate::overstretched, Fate::failed, Fate::too_small, Fate::undefined}) {
    const std::size_t count = totals.fates[fate];
    if (count == 0) continue;
    text += fmt::format("{}{} {} ({:.1f} %)", separator, with_commas(count), name_of(fate),
                        100 * static_cast<double>(count) / static_cast<double>(totals.born));
    separator = ", ";
  }
  return text;
}

// All quantities of a robot, a few per line: "distance 0.731 m".
void print_quantities(const Individual& individual) {
  constexpr std::size_t width = 100;
  std::string text;
  const std::span<const double> values = individual.assessment.values;
  for (std::size_t q = 0; q < std::min(values.size(), quantities().size()); ++q) {
    const Quantity& quantity = quantities()[q];
    if (!counts(quantity, individual.assessment.fate)) continue;
    const std::string item = fmt::format("{} {}{}{}", quantity.name, number_text(values[q]),
                                         quantity.unit.empty() ? "" : " ", quantity.unit);
    if (!text.empty() && text.size() + item.size() + 2 > width) {
      print_line("", text + ",");
      text.clear();
    }
    if (!text.empty()) text += ", ";
    text += item;
  }
  if (!text.empty()) print_line("", text);
}

// Mutants have one parent, children of a crossover two; the line follows the first.
void print_line_of(const RunHistory& run, std::uint64_t id) {
  const std::vector<std::uint64_t> line = run.line_of(id);
  const Individual& oldest = run.individuals()[static_cast<std::size_t>(line.front())];
  print_line("its line", line.size() == 1 ? fmt::format("no ancestors: drawn in generation {}", oldest.generation)
                                          : fmt::format("{}, from robot {} of generation {} ({})",
                                                        counted(line.size() - 1, "ancestor", "ancestors"), oldest.id,
                                                        oldest.generation, score_text(run.settings(), oldest)));
}

// "best/ (20 robots), genomes (1.2 MB), ..."
std::string files_text(const std::filesystem::path& folder) {
  std::vector<std::string> items;
  std::error_code error;
  for (const auto& entry : std::filesystem::directory_iterator(folder, error)) {
    const std::string name = entry.path().filename().string();
    if (name.starts_with(".")) continue;
    if (entry.is_directory(error)) {
      const auto count = std::distance(std::filesystem::directory_iterator(entry.path(), error), {});
      items.push_back(fmt::format("{}/ ({})", name, counted(static_cast<std::size_t>(count), "robot", "robots")));
    } else {
      items.push_back(fmt::format("{} ({})", name, byte_text(entry.file_size(error))));
    }
  }
  std::ranges::sort(items);
  return fmt::format("{}", fmt::join(items, ", "));
}

std::string generations_text(const RunHistory& run) {
  const int planned = run.settings().evolution.generations;
  if (run.generations().empty()) return fmt::format("none of {} yet", planned);
  const int done = run.generations().back().number;
  return done >= planned ? fmt::format("{}, all done", done) : fmt::format("{} of {} done", done, planned);
}

}  // namespace

void describe(const RunHistory& run) {
  const RunSettings& settings = run.settings();
  const Configuration& configuration = settings.evolution.configuration;
  const Totals totals = totals_of(run);
  print_heading(name_of_run(run));
  print_line("made by", settings.program);
  print_line("evolves", genome_text(settings.space));
  print_line("for", fmt::format("{}", fmt::join(settings.evolution.objectives, ", ")));
  print_line("by", algorithm_text(settings.evolution));
  print_line("environment", environment_text(configuration));
  print_line("solver", solver_text(configuration));
  print_line("trials", trials_text(settings.evolution.trials));
  print_line("generations", generations_text(run));
  if (!run.generations().empty()) {
    print_line("robots", individuals_text(run, totals));
    if (totals.seconds > 0)
      print_line("speed", fmt::format("{} robots/s, {} in all, on {}",
                                      number_text(static_cast<double>(totals.born) / totals.seconds),
                                      duration_text(totals.seconds), fmt::join(totals.devices, " and ")));
  }
  if (!run.living().empty()) {
    const Individual& best = run.individuals()[static_cast<std::size_t>(run.living().front())];
    print_line("best",
               fmt::format("robot {} of generation {}: {}", best.id, best.generation, score_text(settings, best)));
    print_quantities(best);
    if (const std::vector<double>& islands = run.generations().back().best_of_islands; !islands.empty()) {
      std::vector<std::string> scores;
      for (const double score : islands) scores.push_back(number_text(score));
      print_line("islands", fmt::format("best scores {}", fmt::join(scores, ", ")));
    }
    print_line_of(run, best.id);
  }
  print_line("files", files_text(run.folder()));
}

}  // namespace mercury
