// SPDX-License-Identifier: Apache-2.0
// The files of a run folder that follow from run.toml and the journal. Each is written whole, so readers find the whole
// old file or the whole new one, and a file that is lost or damaged is made again.
#pragma once

#include <array>
#include <chrono>
#include <cstdint>
#include <filesystem>
#include <string_view>

#include "mercury/robot.h"
#include "mercury/run_folder.h"

namespace mercury {

inline constexpr std::string_view lineage_name = "lineage.csv", first_parents_name = "first_parents.csv",
                                  generations_name = "generations.csv", progress_name = "progress.svg",
                                  champions_name = "best";
inline constexpr std::array derived_file_names{lineage_name, first_parents_name, generations_name, progress_name};

class DerivedFiles {
 public:
  // Champions are written at once. The other files wait until 20 times as long has passed as writing them took; after
  // the last generation they wait for write(), which follows.
  void write_now_and_then(const RunHistory& run);
  // Writes them all.
  void write(const RunHistory& run);

 private:
  using Clock = std::chrono::steady_clock;
  Clock::time_point next_ = Clock::time_point::min();
};

// Writes the champion of each generation that has another one than the previous generation, unless its file is there:
// best/GENERATION-ID.json. A champion that cannot be grown has none, and one that is not confirmed, if the run wants
// that. Nothing for runs of map-elites, whose best/ holds the map.
void write_champions(const RunHistory& run);

// Of a run of map-elites: writes the robots of all cells that have a score, and removes those that are there no more:
// best/GENERATION-ID.json, the generation in which it was born. Nothing for other runs.
void write_elites(const RunHistory& run);

// The robot of an individual, "RUN-ID", with its ancestry in the origin. Throws InputError if it cannot be grown.
Robot run_robot(const RunHistory& run, std::uint64_t id);

// lineage.csv: every individual, in the ALife data standard for phylogenies
// (https://alife-data-standards.github.io/alife-data-standards/phylogeny): id, ancestor_list ("[3,7]", "[none]"),
// origin_time and destruction_time in generations ("inf" for the living). Then generation, line_began, seed, fate, one
// score per objective with its quartiles, hash, and one column per quantity ("robot_length" for the quantity length,
// since tools take a column of that name for the length of a branch).
void write_lineage(const RunHistory& run);

// first_parents.csv: the same individuals with the first of their parents alone, for tools that read trees: id,
// ancestor_list, origin_time, destruction_time, generation and the scores.
void write_first_parents(const RunHistory& run);

// generations.csv: one line per generation. All columns but the last three are the same in every repetition.
void write_generations(const RunHistory& run);

// With those above it. Throws InputError.
void make_folder(const std::filesystem::path& folder);

}  // namespace mercury
