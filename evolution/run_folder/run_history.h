// SPDX-License-Identifier: Apache-2.0
// The encoded genomes of a journal, read when somebody asks for them.
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <memory>
#include <mutex>
#include <span>
#include <string>
#include <unordered_map>
#include <vector>

#include "evolution/run_folder/journal.h"
#include "evolution/run_folder/run_file.h"
#include "mercury/individual.h"
#include "mercury/run_folder.h"

namespace mercury {

class GenomeStore {
 public:
  using Bytes = std::shared_ptr<const std::string>;

  // The journal must outlive the store.
  explicit GenomeStore(const JournalReader& journal) : journal_(journal) {}

  // The genomes of the individuals that follow, in the order of ids. Throws InputError if they cannot be as stored.
  void add(std::span<const StoredGenome> genomes);
  // The differences that lie between a genome and one that is stored whole.
  int chain_of(std::uint64_t id) const { return chains_[id]; }
  // The encoded genome. Several threads may call it. Throws InputError if the journal is damaged there.
  Bytes bytes(std::uint64_t id) const;

 private:
  Bytes cached(std::uint64_t id) const;
  void cache(std::uint64_t id, Bytes bytes) const;

  const JournalReader& journal_;
  std::vector<StoredGenome> genomes_;  // by id
  std::vector<std::uint8_t> chains_;   // by id
  mutable std::mutex mutex_;
  mutable std::unordered_map<std::uint64_t, Bytes> cache_;
  mutable std::size_t cached_bytes_ = 0;
};

// `living` = ids, the best first; `individuals` = everyone, by id.
GenerationSummary summary_of(int number, GenerationTimes times, std::span<const Individual> born,
                             std::span<const std::uint64_t> living, std::span<const Individual> individuals,
                             std::span<const std::uint64_t> first_ancestors, std::size_t objectives);

// What RunHistory and RunFolder know of a run.

// Throws InputError for what is no folder with a run.toml.
void check_run_folder(const std::filesystem::path& folder);

struct RunHistory::Parts {
  Parts(const std::filesystem::path& run, GenomeSpaceMaker maker);

  // Takes what is new in the journal.
  bool refresh(JournalReader::Check check = JournalReader::Check::all);
  const GenomeSpace& space() const;
  GenomePointer genome(std::uint64_t id) const;
  std::vector<std::size_t> species() const;
  // Throws InputError for an individual that was never born.
  void check(std::uint64_t id) const;

  const std::filesystem::path folder;
  RunFile file;
  const GenomeSpaceMaker make_space;
  JournalReader journal;
  GenomeStore genomes{journal};
  std::vector<Individual> individuals;         // by id
  std::vector<std::uint64_t> first_ancestors;  // by id, along first parents
  std::vector<int> died;                       // by id; alive = -1
  std::vector<std::uint64_t> living, living_before;
  std::vector<GenerationSummary> generations;

 private:
  static constexpr int alive = -1;

  void add(GenerationRecord record);
  void use_known_quantities(Assessment& assessment) const;
  void note_deaths(const Generation& generation);
  std::vector<double> best_of_islands() const;

  std::vector<std::size_t> stored_quantity_;  // per quantity of this program, where its value is in the journal
  bool same_quantities_ = true;               // the journal has those of this program, in the same order
  mutable std::once_flag space_made_;
  mutable std::unique_ptr<GenomeSpace> space_;
  // Of species(): those counted so far, who lived after the last of these generations, and the first one born later.
  mutable std::mutex species_mutex_;
  mutable std::vector<std::size_t> species_;
  mutable std::map<std::uint64_t, GenomePointer> species_living_;
  mutable std::uint64_t species_next_ = 0;
};

}  // namespace mercury
