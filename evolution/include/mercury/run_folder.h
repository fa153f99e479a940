// SPDX-License-Identifier: Apache-2.0
// Run folders: an evolution on disk (docs/evolution.md).
//
//     run.toml         the settings: everything that is needed to repeat the run
//     founders/        the robots that the user gave, if any
//     genomes          the journal: one record per generation, appended whole; all that follows derives from it
//     lineage.csv      every individual, in the ALife data standard for phylogenies
//     generations.csv  one line per generation
//     best/            champions as robot files
//     progress.svg     scores over time, or the map of elites
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "mercury/evolution.h"
#include "mercury/genome.h"
#include "mercury/individual.h"
#include "mercury/robot.h"

namespace mercury {

struct RunSettings {
  EvolutionSettings evolution;
  GenomeSpaceRequest space;
  std::string program;  // and version that made the run: "Mercury 0.3.0"
};

// What is known of a generation beside its individuals. It differs from run to run.
struct GenerationTimes {
  double seconds = 0;  // that it took [s]
  std::string device;  // what stepped its robots
};

// Makes the genome space of a run. Programs with genome kinds of their own give their own function.
using GenomeSpaceMaker = std::function<std::unique_ptr<GenomeSpace>(const GenomeSpaceRequest& request)>;

// How the scores of the living are spread, for one objective.
struct ScoreSpread {
  double lower_quartile = worst_score, median = worst_score, upper_quartile = worst_score, highest = worst_score;
};

// How many robots had each fate.
class FateCounts {
 public:
  std::size_t& operator[](Fate fate) { return counts_[static_cast<std::size_t>(fate)]; }
  std::size_t operator[](Fate fate) const { return counts_[static_cast<std::size_t>(fate)]; }
  FateCounts& operator+=(const FateCounts& other) {
    for (std::size_t i = 0; i < counts_.size(); ++i) counts_[i] += other.counts_[i];
    return *this;
  }

 private:
  std::array<std::size_t, static_cast<std::size_t>(last_fate) + 1> counts_{};
};

// A summary of a generation, computed from its individuals.
struct GenerationSummary {
  int number = 0;
  std::size_t born = 0, living = 0;
  FateCounts fates;                 // of those born in it
  std::uint64_t best = 0;           // id of the best living individual
  std::vector<double> best_scores;  // its scores
  double median_score = 0;          // of the living, first objective
  std::size_t scored = 0;           // of the living, those that have more than the worst score
  double score_sum = 0;             // of these, first objective
  double coverage = 0;              // share of a map's cells that they fill; 0 without a map
  std::size_t lines = 0;            // first ancestors of the living, by first parents
  std::vector<ScoreSpread> scores;  // of the living, per objective
  std::vector<double>
      best_of_islands;  // score of the best living individual of each, first objective; without islands empty
  GenerationTimes times;
};

// Reads a run folder, also while another process appends to it. Never writes. A record of the journal that was cut off
// (by kill -9, a power cut, a full disk) counts as not written. Memory: about 0.4 kB per individual; genomes stay on
// disk. Functions that are const may be called from several threads at the same time.
class RunHistory {
 public:
  // Throws InputError in one line for a folder that is no run, is damaged, or is of a newer version.
  explicit RunHistory(const std::filesystem::path& folder, GenomeSpaceMaker make_space = make_genome_space);
  ~RunHistory();
  RunHistory(RunHistory&&) noexcept;
  RunHistory& operator=(RunHistory&&) noexcept;

  // Reads generations that were appended since. Returns whether there were any. Throws InputError if the run was
  // replaced by another one.
  bool refresh();

  const std::filesystem::path& folder() const;
  const RunSettings& settings() const;
  std::span<const GenerationSummary> generations() const;
  // Into how many species the living were divided after each generation; empty if the algorithm has none. Reads the
  // genomes of those who lived, once. Throws as genome().
  std::vector<std::size_t> species() const;
  const GenomeSpace& space() const;  // made at the first call; throws as make_genome_space
  // Every individual that was ever born, by id, without its genome (nullptr).
  std::span<const Individual> individuals() const;
  // The generation after which it no longer lived; nothing if it lives.
  std::optional<int> died(std::uint64_t id) const;
  std::span<const std::uint64_t> living() const;         // after the last generation, the best first
  std::span<const std::uint64_t> living_before() const;  // the same after the generation before

  GenomePointer genome(std::uint64_t id) const;  // read from disk
  // Its robot, "RUN-ID", with its ancestry in the origin. Throws InputError if it cannot be grown.
  Robot grow(std::uint64_t id) const;
  // The line of first parents, from the oldest ancestor to the individual itself.
  std::vector<std::uint64_t> line_of(std::uint64_t id) const;
  // The best of those who lived after that generation.
  std::uint64_t champion(int generation) const;

 private:
  friend class RunFolder;
  struct Parts;
  std::unique_ptr<Parts> parts_;
};

// Puts an evolution of the run's settings where the run ends.
void restore(const RunHistory& history, Evolution& evolution);

// Whether the folder looks like a run: it has a run.toml.
bool is_run_folder(const std::filesystem::path& folder);

// The one process that writes a run folder.
class RunFolder {
 public:
  // Makes a new run. Throws InputError if the folder exists and is not empty; with `force` a run folder (nothing else)
  // is replaced; files in it that are not of the run stay.
  static RunFolder create(const std::filesystem::path& folder, const RunSettings& settings, bool force = false,
                          GenomeSpaceMaker make_space = make_genome_space);
  // Opens a run to go on. A record that was cut off is removed. Throws InputError as RunHistory, and if another process
  // has the folder open.
  static RunFolder open(const std::filesystem::path& folder, GenomeSpaceMaker make_space = make_genome_space);
  ~RunFolder();
  RunFolder(RunFolder&&) noexcept;
  RunFolder& operator=(RunFolder&&) noexcept;

  const RunHistory& history() const;
  const GenomeSpace& space() const;
  // The number of generations may be raised after the fact; run.toml is written again.
  void set_generations(int generations);

  // Appends a generation to the journal; it is on the disk when this returns. The other files follow now and then, so
  // that they take a small share of the time; call write_all() after the last generation. If it cannot be written (a
  // full disk), throws InputError, and the journal is as it was.
  void append(const Generation& generation, const GenerationTimes& times);
  // The same on a thread of its own, while the caller makes the next generations. If more than three wait, it waits for
  // the first of them; all other functions wait for all. They throw what append() would have thrown.
  void append_later(Generation generation, GenerationTimes times);
  // Writes all other files.
  void write_all();

 private:
  struct Parts;
  explicit RunFolder(std::unique_ptr<Parts> parts);
  std::unique_ptr<Parts> parts_;
};

}  // namespace mercury
