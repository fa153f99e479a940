// SPDX-License-Identifier: Apache-2.0
// One evolution on several hosts, in parts that any scheduler can start (docs/evolution.md): each of N processes
// assesses a shard of the next generation and writes a file; then one process merges the files and selects. An
// assessment depends on the genome alone, so the lineage is the same for any number of shards on one kind of device.
#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>

#include "mercury/assessor.h"
#include "mercury/evolution.h"

namespace mercury {

// Assesses part `shard` (1 .. count) of the next generation and writes the result into the run folder's `shards`.
// Returns the file, or nothing if `watch` said to stop. `evolution` stands where the run ended; nothing else is
// written, and several processes may do this at the same time.
std::optional<std::filesystem::path> assess_shard(const std::filesystem::path& folder, const Evolution& evolution,
                                                  Assessor& assessor, std::size_t shard, std::size_t count,
                                                  const Watch& watch = {});

// The next generation from the files of all its shards, selected. Throws InputError in one line if there are none, if
// one is missing or damaged, or belongs to another run or generation; then nothing has changed.
Generation merge_shards(const std::filesystem::path& folder, Evolution& evolution);

// Removes the files of shards of generations before `generation`.
void remove_shards(const std::filesystem::path& folder, int generation);

}  // namespace mercury
