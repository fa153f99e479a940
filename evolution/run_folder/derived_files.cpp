// SPDX-License-Identifier: Apache-2.0
#include "evolution/run_folder/derived_files.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <functional>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "evolution/run_folder/champion_checks.h"
#include "evolution/run_folder/journal.h"
#include "evolution/run_folder/plot.h"
#include "mercury/csv.h"
#include "mercury/error.h"
#include "mercury/number_text.h"
#include "mercury/origin.h"
#include "mercury/parallel.h"
#include "mercury/quantity.h"
#include "mercury/random.h"
#include "mercury/robot_file.h"
#include "robots/file/whole_file.h"

namespace mercury {
namespace {

std::string run_name(const RunHistory& run) {
  const std::filesystem::path folder = std::filesystem::absolute(run.folder()).lexically_normal();
  return (folder.has_filename() ? folder.filename() : folder.parent_path().filename()).string();
}

}  // namespace

Robot run_robot(const RunHistory& run, std::uint64_t id) {
  Robot robot = run.genome(id)->grow(run_name(run) + "-" + std::to_string(id));
  const Individual& individual = run.individuals()[id];
  Ancestry ancestry{.generation = static_cast<std::uint64_t>(individual.generation)};
  for (const std::uint64_t parent : individual.parents)
    ancestry.parents.push_back(run_name(run) + "-" + std::to_string(parent));
  if (!individual.parents.empty() && !individual.is_migrant) ancestry.mutation_seed = individual.seed;
  if (individual.parents.size() > 1) ancestry.crossover_seed = seed_of(individual.seed, 0);
  robot.origin = with_ancestry(robot.origin, ancestry);
  return robot;
}

namespace {

std::string file_name(int generation, std::uint64_t id) {
  char name[64];
  std::snprintf(name, sizeof name, "%05d-%07llu.json", generation, static_cast<unsigned long long>(id));
  return name;
}

std::optional<Robot> grown(const RunHistory& run, std::uint64_t id) {
  const GenomePointer genome = run.genome(id);  // a damaged journal is an error
  try {
    return run.grow(id);
  } catch (const InputError&) {
    return std::nullopt;
  }
}

bool has_map(const RunHistory& run) { return algorithm_of(run.settings().evolution.algorithm).has_map; }

// 0 if its population is not split.
std::size_t islands_of(const RunHistory& run) {
  const std::size_t islands = run.settings().evolution.algorithm.islands;
  return islands > 1 ? islands : 0;
}

}  // namespace

void make_folder(const std::filesystem::path& folder) {
  std::error_code error;
  std::filesystem::create_directories(folder, error);
  if (error) fail(folder, error.value());
}

namespace {

// Whether file_name() gives that name to a robot of the run.
bool is_file_of(const RunHistory& run, const std::string& name) {
  int generation = 0;
  unsigned long long id = 0;
  return std::sscanf(name.c_str(), "%d-%llu.json", &generation, &id) == 2 && id < run.individuals().size() &&
         name == file_name(generation, id);
}

}  // namespace

void write_elites(const RunHistory& run) {
  if (!has_map(run)) return;
  const std::filesystem::path folder = run.folder() / champions_name;
  std::map<std::string, std::uint64_t> elites;
  for (const std::uint64_t id : run.living()) {
    const Individual& individual = run.individuals()[id];
    if (individual.score() > worst_score) elites.emplace(file_name(individual.generation, id), id);
  }
  std::error_code error;
  std::vector<std::filesystem::path> replaced;
  for (std::filesystem::directory_iterator entry(folder, error), end; !error && entry != end; entry.increment(error)) {
    const std::string name = entry->path().filename().string();
    if (!elites.contains(name) && is_file_of(run, name)) replaced.push_back(entry->path());
  }
  for (const std::filesystem::path& path : replaced) std::filesystem::remove(path, error);
  for (const auto& [name, id] : elites) {
    if (std::filesystem::exists(folder / name, error)) continue;
    const std::optional<Robot> robot = grown(run, id);
    if (!robot) continue;
    make_folder(folder);
    save_robot(folder / name, *robot);
  }
}

void write_champions(const RunHistory& run) {
  if (has_map(run)) return;
  const std::filesystem::path folder = run.folder() / champions_name;
  const bool only_confirmed = run.settings().evolution.confirm;
  const Checks checks = only_confirmed ? read_checks(run.folder()) : Checks{};
  std::optional<std::uint64_t> previous;
  for (const GenerationSummary& generation : run.generations()) {
    if (generation.living == 0 || generation.best == previous) continue;
    previous = generation.best;
    const auto check = checks.find(generation.best);
    if (only_confirmed && (check == checks.end() || check->second.verdict != Verdict::confirmed)) continue;
    const std::filesystem::path path = folder / file_name(generation.number, generation.best);
    std::error_code error;
    if (std::filesystem::exists(path, error)) continue;
    const std::optional<Robot> robot = grown(run, generation.best);
    if (!robot) continue;
    make_folder(folder);
    save_robot(path, *robot);
  }
}

namespace {

// "score", or "score_1", "score_2", ... of several objectives.
std::string score_name(std::size_t objective, std::size_t objectives) {
  return objectives == 1 ? "score" : "score_" + std::to_string(objective + 1);
}

std::string ancestor_list(std::span<const std::uint64_t> parents) {
  if (parents.empty()) return "[none]";
  std::string list = "[";
  for (const std::uint64_t parent : parents) list.append(list.size() > 1 ? "," : "").append(std::to_string(parent));
  return list + "]";
}

// A quantity's name, unless tools for phylogenies give a column of that name a meaning of their own.
std::string column_of(const Quantity& quantity) {
  constexpr std::string_view taken[] = {"branch_length", "edge_length", "label",    "length",          "name",
                                        "num_orgs",      "taxon_label", "tot_orgs", "total_offspring", "weight"};
  return (std::ranges::find(taken, quantity.name) == std::end(taken) ? "" : "robot_") + std::string(quantity.name);
}

std::string hexadecimal(std::uint64_t value) {
  char text[20];
  std::snprintf(text, sizeof text, "%016llx", static_cast<unsigned long long>(value));
  return text;
}

void add_quantities(CsvLines& csv, const Assessment& assessment) {
  for (std::size_t q = 0; q < quantities().size(); ++q) {
    const bool has_value =
        q < assessment.values.size() && counts(quantities()[q], assessment.fate) && !std::isnan(assessment.values[q]);
    csv.cell(has_value ? shortest_text(assessment.values[q]) : std::string());
  }
}

// Numbers that an individual may lack.
void add_cells(CsvLines& csv, const std::vector<double>& values, std::size_t count) {
  for (std::size_t i = 0; i < count; ++i) csv.cell(i < values.size() ? shortest_text(values[i]) : std::string());
}

// A line per individual after the head, made on all cores.
std::string lines_of(const RunHistory& run, const CsvLines& head,
                     const std::function<void(const Individual&, CsvLines&)>& add) {
  constexpr std::size_t portion = 256;
  const std::span<const Individual> all = run.individuals();
  std::vector<std::string> parts((all.size() + portion - 1) / portion);
  parallel_for(0, parts.size(), [&](std::size_t part) {
    CsvLines csv;
    for (const Individual& individual : all.subspan(part * portion, std::min(portion, all.size() - part * portion))) {
      add(individual, csv);
      csv.end_line();
    }
    parts[part] = csv.text();
  });
  std::string text = head.text();
  for (const std::string& part : parts) text += part;
  return text;
}

}  // namespace

void write_lineage(const RunHistory& run) {
  const std::size_t objectives = run.settings().evolution.objectives.size();
  CsvLines head;
  const bool has_islands = islands_of(run) > 0;
  for (const char* name :
       {"id", "ancestor_list", "origin_time", "destruction_time", "generation", "line_began", "seed", "fate"})
    head.cell(name);
  if (has_islands) head.cell("island");
  for (std::size_t i = 0; i < objectives; ++i) head.cell(score_name(i, objectives));
  for (std::size_t i = 0; i < objectives; ++i)
    for (const char* name : {"lower_quartile_", "upper_quartile_"}) head.cell(name + score_name(i, objectives));
  head.cell("hash").cell("physics");
  for (const Quantity& quantity : quantities()) head.cell(column_of(quantity));
  head.end_line();
  const std::string_view physics = name_of(physics_of(run.settings().space));
  const auto add = [&](const Individual& individual, CsvLines& csv) {
    const Assessment& assessment = individual.assessment;
    const std::optional<int> died = run.died(individual.id);
    csv.cell(individual.id).cell(ancestor_list(individual.parents)).cell(individual.generation);
    csv.cell(died ? std::to_string(*died) : "inf").cell(individual.generation).cell(individual.line_began);
    csv.cell(individual.seed).cell(name_of(assessment.fate));
    if (has_islands) csv.cell(individual.island);
    add_cells(csv, assessment.scores, objectives);
    for (std::size_t i = 0; i < objectives; ++i)
      for (const std::vector<double>* quartiles : {&assessment.lower_quartiles, &assessment.upper_quartiles})
        csv.cell(i < quartiles->size() ? shortest_text((*quartiles)[i]) : std::string());
    csv.cell(hexadecimal(assessment.hash)).cell(physics);
    add_quantities(csv, assessment);
  };
  write_whole_file(run.folder() / lineage_name, lines_of(run, head, add));
}

void write_first_parents(const RunHistory& run) {
  const std::size_t objectives = run.settings().evolution.objectives.size();
  CsvLines head;
  for (const char* name : {"id", "ancestor_list", "origin_time", "destruction_time", "generation"}) head.cell(name);
  for (std::size_t i = 0; i < objectives; ++i) head.cell(score_name(i, objectives));
  head.end_line();
  const auto add = [&](const Individual& individual, CsvLines& csv) {
    const std::span<const std::uint64_t> parents = individual.parents;
    const std::optional<int> died = run.died(individual.id);
    csv.cell(individual.id).cell(ancestor_list(parents.first(std::min<std::size_t>(1, parents.size()))));
    csv.cell(individual.generation).cell(died ? std::to_string(*died) : "inf").cell(individual.generation);
    add_cells(csv, individual.assessment.scores, objectives);
  };
  write_whole_file(run.folder() / first_parents_name, lines_of(run, head, add));
}

void write_generations(const RunHistory& run) {
  const std::size_t objectives = run.settings().evolution.objectives.size();
  CsvLines csv;
  for (const char* name : {"generation", "born", "living", "best_id"}) csv.cell(name);
  for (std::size_t i = 0; i < objectives; ++i)
    for (const char* name : {"best_", "upper_quartile_", "median_", "lower_quartile_"})
      csv.cell(name + score_name(i, objectives));
  for (const char* name :
       {"sound", "stopped", "exploded", "overstretched", "too_small", "undefined", "failed", "lines", "species",
        "cells", "coverage", "qd_score", "physics", "seconds", "robots_per_second", "device"})
    csv.cell(name);
  for (std::size_t i = 0; i < islands_of(run); ++i) csv.cell("best_of_island_" + std::to_string(i));
  csv.end_line();
  const std::vector<std::size_t> species = run.species();
  for (const GenerationSummary& generation : run.generations()) {
    csv.cell(generation.number).cell(generation.born).cell(generation.living).cell(generation.best);
    for (const ScoreSpread& scores : generation.scores)
      csv.cell(scores.highest).cell(scores.upper_quartile).cell(scores.median).cell(scores.lower_quartile);
    for (const Fate fate : {Fate::sound, Fate::stopped, Fate::exploded, Fate::overstretched, Fate::too_small,
                            Fate::undefined, Fate::failed})
      csv.cell(generation.fates[fate]);
    csv.cell(generation.lines)
        .cell(species.empty() ? std::string() : std::to_string(species[static_cast<std::size_t>(generation.number)]));
    if (has_map(run))
      csv.cell(generation.scored).cell(generation.coverage).cell(generation.score_sum);
    else
      csv.cell(std::string()).cell(std::string()).cell(std::string());
    csv.cell(name_of(physics_of(run.settings().space)));
    const double seconds = generation.times.seconds;
    csv.cell(fixed_text(seconds, 3))
        .cell(seconds > 0 ? fixed_text(static_cast<double>(generation.born) / seconds, 1) : std::string())
        .cell(generation.times.device);
    for (const double best : generation.best_of_islands) csv.cell(best);
    csv.end_line();
  }
  write_whole_file(run.folder() / generations_name, csv.text());
}

void DerivedFiles::write_now_and_then(const RunHistory& run) {
  write_champions(run);
  const bool is_over = run.generations().back().number >= run.settings().evolution.generations;
  if (!is_over && Clock::now() >= next_) write(run);
}

void DerivedFiles::write(const RunHistory& run) {
  constexpr int pauses = 20;  // as long as the writing, so that it takes at most a 21st part of the time
  const Clock::time_point start = Clock::now();
  write_champions(run);
  write_elites(run);
  write_lineage(run);
  write_first_parents(run);
  write_generations(run);
  write_whole_file(run.folder() / progress_name, progress_plot(run));
  const Clock::time_point end = Clock::now();
  next_ = end + pauses * (end - start);
}

}  // namespace mercury
