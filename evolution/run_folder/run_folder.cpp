// SPDX-License-Identifier: Apache-2.0
#include "mercury/run_folder.h"

#include <algorithm>
#include <deque>
#include <future>
#include <limits>
#include <utility>

#include "evolution/run_folder/derived_files.h"
#include "evolution/run_folder/generation_record.h"
#include "evolution/run_folder/journal.h"
#include "evolution/run_folder/run_history.h"
#include "mercury/error.h"
#include "mercury/file_links.h"
#include "mercury/parallel.h"
#include "mercury/quantity.h"
#include "robots/bytes.h"
#include "robots/file/whole_file.h"

namespace mercury {

struct RunFolder::Parts {
  Parts(const std::filesystem::path& folder, JournalWriter locked, GenomeSpaceMaker make_space)
      : writer(std::move(locked)), history(folder, std::move(make_space)) {}

  // Waits until at most `most` of the generations of append_later() are not yet written.
  void settle(std::size_t most = 0) {
    while (later.size() > most) {
      const std::shared_future<void> first = later.front();
      later.pop_front();
      first.get();
    }
  }
  void append(Generation generation, const GenerationTimes& times);

  JournalWriter writer;  // holds the lock, so the history is read after it was taken
  RunHistory history;
  DerivedFiles derived;
  ThreadPool few_threads{
      std::max(1, static_cast<int>(parallel_threads() / 4))};  // the next generation needs the others
  std::deque<std::shared_future<void>> later;                  // last: they use the others
};

namespace {

// The genomes of those born, one after another: whole, or as the difference from the first parent's.
std::string store_genomes(GenerationRecord& record, const GenomeStore& store) {
  std::vector<Individual>& born = record.generation.born;
  std::vector<std::string> stored(born.size());
  record.genomes.resize(born.size());
  parallel_for(0, born.size(), [&](std::size_t i) {
    StoredGenome& genome = record.genomes[i];
    stored[i] = born[i].genome->encode();
    if (!born[i].parents.empty() && store.chain_of(born[i].parents.front()) < longest_chain) {
      const std::uint64_t parent = born[i].parents.front();
      std::string difference = difference_of(*store.bytes(parent), stored[i]);
      if (difference.size() < stored[i].size()) {
        stored[i] = std::move(difference);
        genome.base = parent;
      }
    }
    genome.size = static_cast<std::uint32_t>(stored[i].size());
    genome.checksum = short_checksum_of(stored[i]);
    born[i].genome = nullptr;
  });
  std::string genomes;
  for (const std::string& bytes : stored) genomes += bytes;
  return genomes;
}

// Values in the order that the journal has, which may be of another version of this program.
void use_stored_quantities(Assessment& assessment, const std::vector<std::string>& names) {
  if (assessment.values.empty()) return;
  std::vector<double> values;
  for (const std::string& name : names) {
    const std::optional<std::size_t> q = find_quantity(name);
    values.push_back(q && *q < assessment.values.size() ? assessment.values[*q]
                                                        : std::numeric_limits<double>::quiet_NaN());
  }
  assessment.values = std::move(values);
}

}  // namespace

RunFolder::RunFolder(std::unique_ptr<Parts> parts) : parts_(std::move(parts)) {}
RunFolder::~RunFolder() = default;
RunFolder::RunFolder(RunFolder&&) noexcept = default;
RunFolder& RunFolder::operator=(RunFolder&&) noexcept = default;

RunFolder RunFolder::create(const std::filesystem::path& folder, const RunSettings& settings, bool force,
                            GenomeSpaceMaker make_space) {
  validate(settings.evolution, *make_space(settings.space));  // throws before anything is written or removed
  JournalWriter journal = make_run_folder(folder, settings, force);
  return RunFolder(std::make_unique<Parts>(folder, std::move(journal), std::move(make_space)));
}

RunFolder RunFolder::open(const std::filesystem::path& folder, GenomeSpaceMaker make_space) {
  check_run_folder(folder);
  for (const auto& entry : std::filesystem::recursive_directory_iterator(folder)) {
    if (entry.is_symlink()) require_inside(folder, entry.path());
    if (is_device_or_pipe(entry.path())) throw InputError(entry.path().string(), "not a regular file");
  }
  auto parts = std::make_unique<Parts>(folder, JournalWriter::open(folder / journal_name), std::move(make_space));
  parts->history.space();
  parts->writer.cut(parts->history.parts_->journal.end());
  return RunFolder(std::move(parts));
}

const RunHistory& RunFolder::history() const {
  parts_->settle();
  return parts_->history;
}
const GenomeSpace& RunFolder::space() const { return parts_->history.space(); }

void RunFolder::set_generations(int generations) {
  parts_->settle();
  RunHistory::Parts& run = *parts_->history.parts_;
  if (generations < 0) throw ParameterError("generations", "give 0 or more");
  const std::filesystem::path path = run.folder / run_file_name;
  write_whole_file(path, with_generations(path, read_whole_file(path), generations));
  run.file.settings.evolution.generations = generations;
}

void restore(const RunHistory& history, Evolution& evolution) {
  if (history.generations().empty()) return;
  history.space();  // made once, before several threads need it
  const auto with_genomes = [&](std::span<const std::uint64_t> ids) {
    std::vector<Individual> individuals(ids.size());
    parallel_for(0, ids.size(), [&](std::size_t i) {
      individuals[i] = history.individuals()[ids[i]];
      individuals[i].genome = history.genome(ids[i]);
    });
    return individuals;
  };
  evolution.restore(history.generations().back().number, with_genomes(history.living()), history.individuals(),
                    evolution.settings().pipelined ? with_genomes(history.living_before()) : std::vector<Individual>());
}

void RunFolder::append(const Generation& generation, const GenerationTimes& times) {
  parts_->settle();
  parts_->append(generation, times);
}

void RunFolder::append_later(Generation generation, GenerationTimes times) {
  constexpr std::size_t most_waiting = 3;
  parts_->settle(most_waiting);
  const std::shared_future<void> before = parts_->later.empty() ? std::shared_future<void>() : parts_->later.back();
  parts_->later.push_back(std::async(std::launch::async, [&parts = *parts_, before, generation = std::move(generation),
                                                          times = std::move(times)]() mutable {
                            if (before.valid()) before.get();
                            parts.few_threads.execute([&] { parts.append(std::move(generation), times); });
                          }).share());
}

void RunFolder::Parts::append(Generation generation, const GenerationTimes& times) {
  RunHistory::Parts& run = *history.parts_;
  if (generation.number != static_cast<int>(run.generations.size()))
    throw InputError(run.folder.string(), "generation " + std::to_string(generation.number) + " does not follow the " +
                                              std::to_string(run.generations.size()) + " generations of the run");
  GenerationRecord record{.first_id = run.individuals.size(), .generation = std::move(generation), .times = times};
  const std::string genomes = store_genomes(record, run.genomes);
  for (Individual& born : record.generation.born) use_stored_quantities(born.assessment, run.file.quantities);
  run.journal.check_not_replaced();
  writer.append(record, genomes, run.journal.version());
  run.refresh(JournalReader::Check::index);
  derived.write_now_and_then(history);
}

void RunFolder::write_all() {
  parts_->settle();
  parts_->history.parts_->journal.check_not_replaced();
  parts_->derived.write(parts_->history);
}

}  // namespace mercury
