// SPDX-License-Identifier: Apache-2.0
// A sweep: a folder of runs that differ in settings (variants) and seeds.
//
//     SWEEP/algorithm=ga/seed-1/     a run folder (mercury/run_folder.h)
//     SWEEP/sweep.csv                a line per run
//     SWEEP/sweep.svg                the best score over robots tried: median and middle half of the runs of a variant
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

namespace mercury {

struct SweptRun {
  std::uint64_t seed = 0;
  std::filesystem::path folder;
  // After each generation: robots tried so far, and the best score of the living in the first objective.
  std::vector<std::size_t> tried;
  std::vector<double> best;
  bool done = false;
};

struct SweepVariant {
  std::string name;
  std::vector<SweptRun> runs;  // by seed
};

struct Sweep {
  std::string objective;               // the first one of the first run
  std::vector<SweepVariant> variants;  // by name
  bool empty() const { return variants.empty(); }
};

// The run folders of a sweep, by variant and seed, without reading them. Empty = it is no sweep.
std::vector<std::filesystem::path> runs_of_sweep(const std::filesystem::path& folder);
// Throws InputError for a run that is damaged.
Sweep read_sweep(const std::filesystem::path& folder);

std::string sweep_csv(const Sweep& sweep);
std::string sweep_plot(const Sweep& sweep);
// A line per variant: its runs, the median and the quartiles of their last best scores, and how probable a difference
// like that from the first variant is by chance (rank_test()).
std::string sweep_table(const Sweep& sweep);

// The test of Mann and Whitney (1947) of whether two samples come from one distribution: the probability of ranks at
// least this uneven, to both sides, if they do. Exact for up to 20 values each without ties, else by the normal
// distribution with corrections for ties and continuity. 1 if a sample is empty.
double rank_test(std::span<const double> a, std::span<const double> b);

}  // namespace mercury
