// SPDX-License-Identifier: Apache-2.0
#include "evolution/run_folder/run_history.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>
#include <utility>

#include "evolution/run_folder/derived_files.h"
#include "evolution/run_folder/generation_record.h"
#include "evolution/selection/islands.h"
#include "mercury/error.h"
#include "mercury/quantity.h"
#include "mercury/spread.h"
#include "robots/bytes.h"
#include "robots/file/whole_file.h"

namespace mercury {
namespace {

constexpr std::size_t most_cached_bytes = std::size_t{128} << 20;

}  // namespace

void GenomeStore::add(std::span<const StoredGenome> genomes) {
  for (const StoredGenome& genome : genomes) {
    const int chain = genome.base == StoredGenome::none ? 0 : chains_.at(genome.base) + 1;
    if (chain > longest_chain)
      throw InputError(journal_.path().string(),
                       "the genome of individual " + std::to_string(genomes_.size()) + " has too many differences");
    genomes_.push_back(genome);
    chains_.push_back(static_cast<std::uint8_t>(chain));
  }
}

GenomeStore::Bytes GenomeStore::bytes(std::uint64_t id) const {
  std::vector<std::uint64_t> differences;  // to be applied, the last one first
  Bytes bytes = cached(id);
  for (; !bytes; bytes = cached(id)) {
    const StoredGenome& genome = genomes_.at(id);
    if (genome.base == StoredGenome::none) {
      bytes = std::make_shared<const std::string>(journal_.bytes_of(genome, id));
      cache(id, bytes);
      break;
    }
    differences.push_back(id);
    id = genome.base;
  }
  for (; !differences.empty(); differences.pop_back()) {
    const std::uint64_t next = differences.back();
    try {
      bytes = std::make_shared<const std::string>(with_difference(*bytes, journal_.bytes_of(genomes_[next], next)));
    } catch (const DamagedBytes& error) {
      throw InputError(journal_.path().string(),
                       "the genome of individual " + std::to_string(next) + ": " + error.what());
    }
    cache(next, bytes);
  }
  return bytes;
}

GenomeStore::Bytes GenomeStore::cached(std::uint64_t id) const {
  const std::lock_guard lock(mutex_);
  const auto found = cache_.find(id);
  return found == cache_.end() ? nullptr : found->second;
}

void GenomeStore::cache(std::uint64_t id, Bytes bytes) const {
  const std::lock_guard lock(mutex_);
  if (cached_bytes_ > most_cached_bytes) {
    cache_.clear();
    cached_bytes_ = 0;
  }
  const std::size_t size = bytes->size();
  if (cache_.emplace(id, std::move(bytes)).second) cached_bytes_ += size;
}

namespace {

ScoreSpread score_spread_of(std::span<const std::uint64_t> living, std::span<const Individual> individuals,
                            std::size_t objective) {
  std::vector<double> scores;
  for (const std::uint64_t id : living) {
    const std::vector<double>& all = individuals[id].assessment.scores;
    scores.push_back(all.empty() ? worst_score : all[objective]);
  }
  if (scores.empty()) return {};
  std::ranges::sort(scores);
  return {quantile(scores, 0.25), quantile(scores, 0.5), quantile(scores, 0.75), scores.back()};
}

}  // namespace

GenerationSummary summary_of(int number, GenerationTimes times, std::span<const Individual> born,
                             std::span<const std::uint64_t> living, std::span<const Individual> individuals,
                             std::span<const std::uint64_t> first_ancestors, std::size_t objectives) {
  GenerationSummary summary{.number = number, .born = born.size(), .living = living.size()};
  for (const Individual& individual : born) ++summary.fates[individual.assessment.fate];
  if (!living.empty()) {
    summary.best = living.front();
    summary.best_scores = individuals[living.front()].assessment.scores;
  }
  std::set<std::uint64_t> lines;
  for (const std::uint64_t id : living) {
    lines.insert(first_ancestors[id]);
    const double score = individuals[id].score();
    if (!(score > worst_score)) continue;
    ++summary.scored;
    summary.score_sum += score;
  }
  summary.lines = lines.size();
  for (std::size_t i = 0; i < objectives; ++i) summary.scores.push_back(score_spread_of(living, individuals, i));
  summary.median_score = summary.scores.empty() ? worst_score : summary.scores.front().median;
  summary.times = std::move(times);
  return summary;
}

namespace {

std::filesystem::path checked(const std::filesystem::path& folder) {
  check_run_folder(folder);
  return folder;
}

}  // namespace

void check_run_folder(const std::filesystem::path& folder) {
  std::error_code error;
  if (!std::filesystem::exists(folder, error)) throw InputError(folder.string(), "No such file or directory");
  if (!std::filesystem::is_directory(folder, error)) throw InputError(folder.string(), "is not a folder");
  const bool is_run = std::filesystem::exists(folder / run_file_name, error);
  if (error) fail(folder, error.value());
  if (!is_run) throw InputError(folder.string(), "is not the folder of a run: it has no " + std::string(run_file_name));
}

RunHistory::Parts::Parts(const std::filesystem::path& run, GenomeSpaceMaker maker)
    : folder(checked(run)), file(read_run_file(run)), make_space(std::move(maker)), journal(run / journal_name) {
  if (journal.fingerprint() != file.fingerprint)
    throw InputError((folder / run_file_name).string(),
                     "differs from the settings that the run began with; only generations, device and threads may be "
                     "changed");
  for (const Quantity& quantity : quantities()) {
    const auto found = std::ranges::find(file.quantities, quantity.name);
    stored_quantity_.push_back(static_cast<std::size_t>(found - file.quantities.begin()));
  }
  for (std::size_t i = 0; i < stored_quantity_.size(); ++i) same_quantities_ &= stored_quantity_[i] == i;
  same_quantities_ &= stored_quantity_.size() == file.quantities.size();
  refresh();
}

bool RunHistory::Parts::refresh(JournalReader::Check check) {
  const std::size_t before = generations.size();
  while (std::optional<GenerationRecord> record = journal.next(check)) add(std::move(*record));
  if (generations.size() == before) journal.check_not_replaced();
  return generations.size() > before;
}

void RunHistory::Parts::use_known_quantities(Assessment& assessment) const {
  if (same_quantities_ || assessment.values.empty()) return;
  std::vector<double> values;
  for (const std::size_t q : stored_quantity_)
    values.push_back(q < assessment.values.size() ? assessment.values[q] : std::numeric_limits<double>::quiet_NaN());
  assessment.values = std::move(values);
}

void RunHistory::Parts::add(GenerationRecord record) {
  Generation& generation = record.generation;
  const auto damaged = [&](const char* problem) {
    throw InputError(journal.path().string(), "generation " + std::to_string(generation.number) + ": " + problem);
  };
  const std::size_t objectives = file.settings.evolution.objectives.size();
  for (Individual& individual : generation.born) {
    Assessment& assessment = individual.assessment;
    if (assessment.scores.size() != objectives && !assessment.scores.empty())
      damaged("an individual has another number of scores");
    if (assessment.values.size() != file.quantities.size() && !assessment.values.empty())
      damaged("an individual has another number of values");
    use_known_quantities(assessment);
    if (individual.island >= file.settings.evolution.algorithm.islands)
      damaged("an individual is on an island that the run does not have");
  }
  genomes.add(record.genomes);
  for (const Individual& individual : generation.born)
    first_ancestors.push_back(individual.parents.empty() ? first_ancestors.size()
                                                         : first_ancestors[individual.parents.front()]);
  std::ranges::move(generation.born, std::back_inserter(individuals));
  died.resize(individuals.size(), alive);
  living_before = living;
  note_deaths(generation);
  living = std::move(generation.living);
  generations.push_back(summary_of(generation.number, std::move(record.times),
                                   std::span(individuals).subspan(record.first_id), living, individuals,
                                   first_ancestors, objectives));
  const AlgorithmSettings& algorithm = file.settings.evolution.algorithm;
  if (GenerationSummary& last = generations.back(); algorithm_of(algorithm).has_map)
    last.coverage = static_cast<double>(last.scored) / static_cast<double>(map_cells(algorithm));
  if (algorithm.islands > 1) generations.back().best_of_islands = best_of_islands();
}

std::vector<double> RunHistory::Parts::best_of_islands() const {
  std::vector<double> best(file.settings.evolution.algorithm.islands, worst_score);
  for (const std::uint64_t id : living) {
    double& score = best[individuals[id].island];
    score = std::max(score, individuals[id].score());
  }
  return best;
}

void RunHistory::Parts::note_deaths(const Generation& generation) {
  std::vector<std::uint64_t> candidates = std::move(living);
  for (std::uint64_t id = individuals.size() - generation.born.size(); id < individuals.size(); ++id)
    candidates.push_back(id);
  for (const std::uint64_t id : candidates) died[id] = generation.number;
  for (const std::uint64_t id : generation.living) {
    if (died[id] != generation.number)
      throw InputError(journal.path().string(), "generation " + std::to_string(generation.number) +
                                                    ": someone lives who was dead, or lives twice");
    died[id] = alive;
  }
}

const GenomeSpace& RunHistory::Parts::space() const {
  std::call_once(space_made_, [&] { space_ = make_space(file.settings.space); });
  return *space_;
}

void RunHistory::Parts::check(std::uint64_t id) const {
  if (id < individuals.size()) return;
  throw InputError(folder.string(), "there is no individual " + std::to_string(id) + "; the run has " +
                                        std::to_string(individuals.size()));
}

GenomePointer RunHistory::Parts::genome(std::uint64_t id) const {
  check(id);
  const GenomeStore::Bytes bytes = genomes.bytes(id);
  try {
    return space().decode(*bytes);
  } catch (const InputError& error) {
    throw InputError(journal.path().string(), "individual " + std::to_string(id) + ": " + error.what());
  }
}

std::vector<std::size_t> RunHistory::Parts::species() const {
  const AlgorithmSettings& algorithm = file.settings.evolution.algorithm;
  if (!algorithm_of(algorithm).of_species) return {};
  const std::lock_guard lock(species_mutex_);
  const Islands islands(algorithm);
  while (species_.size() < generations.size()) {
    const auto number = static_cast<int>(species_.size());
    const auto lives_on = [&](std::uint64_t id) { return died[id] == alive || died[id] > number; };
    std::map<std::uint64_t, GenomePointer> living_then;
    for (const auto& [id, genome] : species_living_)
      if (lives_on(id)) living_then.emplace(id, genome);
    std::uint64_t next = species_next_;
    for (; next < individuals.size() && individuals[next].generation == number; ++next)
      if (lives_on(next)) living_then.emplace(next, genome(next));
    std::vector<Individual> all;
    for (const auto& [id, genome] : living_then) all.emplace_back(individuals[id]).genome = genome;
    species_.push_back(islands.species(all));
    species_living_ = std::move(living_then);
    species_next_ = next;
  }
  return species_;
}

RunHistory::RunHistory(const std::filesystem::path& folder, GenomeSpaceMaker make_space)
    : parts_(std::make_unique<Parts>(folder, std::move(make_space))) {}
RunHistory::~RunHistory() = default;
RunHistory::RunHistory(RunHistory&&) noexcept = default;
RunHistory& RunHistory::operator=(RunHistory&&) noexcept = default;

bool RunHistory::refresh() { return parts_->refresh(); }

const std::filesystem::path& RunHistory::folder() const { return parts_->folder; }
const RunSettings& RunHistory::settings() const { return parts_->file.settings; }
std::span<const GenerationSummary> RunHistory::generations() const { return parts_->generations; }
const GenomeSpace& RunHistory::space() const { return parts_->space(); }
std::span<const Individual> RunHistory::individuals() const { return parts_->individuals; }
std::span<const std::uint64_t> RunHistory::living() const { return parts_->living; }
std::span<const std::uint64_t> RunHistory::living_before() const { return parts_->living_before; }

std::optional<int> RunHistory::died(std::uint64_t id) const {
  parts_->check(id);
  return parts_->died[id] < 0 ? std::nullopt : std::optional(parts_->died[id]);
}

std::vector<std::size_t> RunHistory::species() const { return parts_->species(); }
GenomePointer RunHistory::genome(std::uint64_t id) const { return parts_->genome(id); }

Robot RunHistory::grow(std::uint64_t id) const { return run_robot(*this, id); }

std::vector<std::uint64_t> RunHistory::line_of(std::uint64_t id) const {
  parts_->check(id);
  std::vector<std::uint64_t> line{id};
  while (!parts_->individuals[line.back()].parents.empty())
    line.push_back(parts_->individuals[line.back()].parents.front());
  std::ranges::reverse(line);
  return line;
}

std::uint64_t RunHistory::champion(int generation) const {
  if (generation < 0 || generation >= static_cast<int>(parts_->generations.size()))
    throw InputError(parts_->folder.string(), "there is no generation " + std::to_string(generation) +
                                                  "; the run has " + std::to_string(parts_->generations.size()));
  return parts_->generations[static_cast<std::size_t>(generation)].best;
}

bool is_run_folder(const std::filesystem::path& folder) {
  std::error_code error;
  return std::filesystem::exists(folder / run_file_name, error);
}

}  // namespace mercury
