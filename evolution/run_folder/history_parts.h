// SPDX-License-Identifier: Apache-2.0
// What RunHistory and RunFolder know of a run.
#pragma once

#include <mutex>

#include "evolution/run_folder/genome_store.h"
#include "evolution/run_folder/journal.h"
#include "evolution/run_folder/run_file.h"
#include "mercury/run_folder.h"

namespace mercury {

// Throws InputError for what is no folder with a run.toml.
void check_run_folder(const std::filesystem::path& folder);

struct RunHistory::Parts {
  Parts(const std::filesystem::path& run, GenomeSpaceMaker maker);

  // Takes what is new in the journal.
  bool refresh();
  const GenomeSpace& space() const;
  GenomePointer genome(std::uint64_t id) const;
  // Throws InputError for an individual that was never born.
  void check(std::uint64_t id) const;

  const std::filesystem::path folder;
  RunFile file;
  const GenomeSpaceMaker make_space;
  JournalReader journal;
  GenomeStore genomes{journal};
  std::vector<Individual> individuals;  // by id
  std::vector<int> died;                // by id; alive = -1
  std::vector<std::uint64_t> living;
  std::vector<GenerationSummary> generations;

 private:
  static constexpr int alive = -1;

  void add(GenerationRecord record);
  void use_known_quantities(Assessment& assessment) const;
  void note_deaths(const Generation& generation);

  std::vector<std::size_t> stored_quantity_;  // per quantity of this program, where its value is in the journal
  bool same_quantities_ = true;               // the journal has those of this program, in the same order
  mutable std::once_flag space_made_;
  mutable std::unique_ptr<GenomeSpace> space_;
};

}  // namespace mercury
