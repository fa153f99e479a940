// SPDX-License-Identifier: Apache-2.0
// How a step kernel is launched: robots and warps per block, and what lies in shared memory. Needs no CUDA, so that
// every build can compute what a robot needs.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <optional>

#include "mercury/configuration.h"
#include "mercury/host_device.h"
#include "sim/cuda/layout.h"

namespace mercury::cuda {

// What a launch keeps of a robot's brain (brain_tables.h) [bytes].
struct BrainBytes {
  std::uint32_t scratch = 0, tables = 0, weights = 0;
  MERCURY_HOST_DEVICE std::uint32_t total() const { return scratch + tables + weights; }
  // The larger of each.
  BrainBytes with(const BrainBytes& other) const {
    return {std::max(scratch, other.scratch), std::max(tables, other.tables), std::max(weights, other.weights)};
  }
};

struct LaunchConfiguration {
  std::uint32_t robots_per_block = 1;
  std::uint32_t warps_per_robot = 1;                   // or per part of one
  std::uint32_t inverse_warps = 65537;                 // warp * inverse_warps / 65536 = number of the warp's robot
  bool even_tiles = true;                              // all warps have as many tiles, see first_tile_of()
  bool apart = false;                                  // robots of a block go on apart (block_layout.h)
  bool first_warps_write = false;                      // the material table, else the last ones
  std::uint32_t parts = 1;                             // of a robot, each in a block of its own (parts.h)
  std::uint32_t table_copy_bits = 0;                   // 2^this many copies of the material table, at most 16
  std::uint32_t bytes_per_material = 0;                // in all of these copies
  std::uint32_t table_chunks = max_materials / lanes;  // of 32 materials in a table
  bool shared_table = false;                           // all robots of the batch have the same materials
  bool on_chip = true;                                 // working memory in shared memory, else in the workspace
  bool valence_on_chip = true;                         // with field_valence, which XPBD reads
  std::uint32_t contact_buckets = 0;                   // a power of two, or 0 = no self-collision
  std::uint32_t record_words = 2;                      // of the batch
  bool viscous = false;                                // springs have relaxation times
  bool contacts_on_chip = true;                        // their grid, else after the working memory in the workspace
  BrainBytes brain;                                    // of each robot on the chip; 0 = in device memory
  std::size_t shared_bytes = 0;
  // Of a multiprocessor's memory, what its blocks need; the rest caches what they read in every step. Kernels that
  // share a multiprocessor must divide it alike (CudaBackend::divide_memory()). [%]
  std::uint32_t shared_percent = 100;
};

// The warps that the kernel's registers allow on a multiprocessor.
inline constexpr std::uint32_t resident_warps = 28;
// Tiles that a warp computes in turn where there are more tiles than warps: enough to hide the cost of a barrier, few
// enough to share the work evenly.
inline constexpr std::uint32_t most_turns = 3;

// The fewest warps that finish a robot's tiles in as many turns as `share` warps would, but in no more than most_turns
// if `max_warps` can do that. `share` = of a multiprocessor's warps, if all robots have as many; with many robots, 1.
constexpr std::uint32_t even_warps(std::uint32_t tiles, std::uint32_t max_warps, std::uint32_t share = 1) {
  return divide_up(tiles, std::max(divide_up(tiles, max_warps), std::min(most_turns, divide_up(tiles, share))));
}

// The first tile of each of a robot's warps, if they share its tiles; that of `warps` is the end. The last warps have a
// tile more than the others, since the last tile may be partly empty.
MERCURY_HOST_DEVICE constexpr std::uint32_t first_tile_of(std::uint32_t warp, std::uint32_t tiles,
                                                          std::uint32_t warps) {
  const std::uint32_t each = tiles / warps, before = warps - tiles % warps;
  return warp * each + (warp > before ? warp - before : 0);
}

// The configuration that keeps most robots in flight on the current device, beside the rest of `batch_size` robots.
// Springs name materials below 32 `table_chunks`.
LaunchConfiguration choose_launch_configuration(const Configuration& configuration, const BatchView& robots,
                                                bool same_materials, bool viscous, std::size_t batch_size,
                                                std::uint32_t table_chunks = max_materials / lanes,
                                                const BrainBytes& brain = {});

// More than any device steps at once.
inline constexpr std::uint32_t many_robots = 1u << 20;

// Whether robots that fit on one multiprocessor, as `whole` steps them, are faster in parts (docs/experiments.md):
// large ones, if the batch leaves multiprocessors idle.
bool is_faster_in_parts(const LaunchConfiguration& whole, std::uint32_t tiles, std::size_t batch_size);

// The same for robots in parts: one part per block. `parts` = DeviceParts::view(). Returns nothing if a part does not
// fit. `blocks` = that a multiprocessor should have at the same time.
std::optional<LaunchConfiguration> choose_launch_in_parts(const Configuration& configuration, const BatchView& parts,
                                                          bool same_materials, bool viscous, std::uint32_t table_chunks,
                                                          std::uint32_t blocks);

}  // namespace mercury::cuda
