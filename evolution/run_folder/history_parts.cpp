// SPDX-License-Identifier: Apache-2.0
#include "evolution/run_folder/history_parts.h"

#include <algorithm>
#include <limits>

#include "evolution/run_folder/generation_summary.h"
#include "mercury/error.h"
#include "mercury/quantity.h"
#include "robots/whole_file.h"

namespace mercury {
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

bool RunHistory::Parts::refresh() {
  const std::size_t before = generations.size();
  while (std::optional<GenerationRecord> record = journal.next()) add(std::move(*record));
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
  }
  genomes.add(record.genomes);
  std::ranges::move(generation.born, std::back_inserter(individuals));
  died.resize(individuals.size(), alive);
  note_deaths(generation);
  living = std::move(generation.living);
  generations.push_back(summary_of(generation.number, std::move(record.times),
                                   std::span(individuals).subspan(record.first_id), living, individuals, objectives));
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

}  // namespace mercury
