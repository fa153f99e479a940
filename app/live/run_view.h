// SPDX-License-Identifier: Apache-2.0
// What the window shows of an evolution: copies of parts of a run folder (mercury/run_folder.h). They are made in the
// background and do not change, so the window reads them while the run goes on.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <vector>

#include "mercury/run_folder.h"

namespace mercury {

// An individual that was the best of a generation.
struct Champion {
  int since = 0;  // the first such generation
  Individual individual;
};

// The best individual of each cell of a map of elites. Of more than two axes, the first two are shown: a cell then has
// the best of all cells that differ only in the others.
struct EliteMap {
  std::vector<MapAxis> axes;  // one or two; empty = the run has no map
  std::size_t columns = 0, rows = 0;
  std::vector<std::optional<Individual>> cells;  // [row][column]; rows from the lowest value of the second axis
  std::size_t filled() const;
};

struct RunView {
  std::filesystem::path folder;
  std::uint64_t opening = 0;  // differs after the run was replaced or its settings were changed
  EvolutionSettings settings;
  std::vector<GenerationSummary> generations;
  std::vector<Champion> champions;  // the oldest first, each individual once
  EliteMap map;
  std::vector<std::uint64_t> best;  // for the scene: ids of some of the best that differ, the best first

  int generation() const { return generations.empty() ? -1 : generations.back().number; }  // the last one; -1 = none
  bool is_over() const { return generation() >= settings.generations; }
};

// One individual of a line of ancestors.
struct FamilyMember {
  Individual individual;
  std::optional<Individual> other_parent;  // after a crossover, the parent that is not in the line
};

// An individual and the line of its first parents.
struct Family {
  std::vector<FamilyMember> line;  // the individual itself first, then parent after parent
  std::size_t children = 0;        // of the individual itself
  std::optional<int> died;         // the generation after which it no longer lived
};

// Reads a run folder, also while the run goes on. Used by one thread.
class RunReader {
 public:
  explicit RunReader(std::filesystem::path folder) : folder_(std::move(folder)) {}

  const std::filesystem::path& folder() const { return folder_; }
  // The run as it is now; null if it is as it was at the last call. Throws InputError, in one line, if it cannot be
  // read; the next call then starts from scratch.
  std::shared_ptr<const RunView> read();
  // Of individuals in the last view. Throw InputError.
  Family family(std::uint64_t id) const;
  Robot grow(std::uint64_t id) const;

 private:
  bool update();
  const RunHistory& history(std::uint64_t id) const;

  std::filesystem::path folder_;
  std::optional<RunHistory> history_;
  std::filesystem::file_time_type settings_time_;  // of the run.toml that was read
  std::uint64_t openings_ = 0;
  bool failed_ = false;  // the last read() has thrown
};

}  // namespace mercury
