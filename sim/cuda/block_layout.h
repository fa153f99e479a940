// SPDX-License-Identifier: Apache-2.0
// A block of the step kernel: its robots, its warps, and its shared memory.
//
// A block steps `robots_per_block` robots side by side. Each robot has `warps_per_robot` warps, which share its tiles:
//
//   block        | robot 2 b                            | robot 2 b + 1                        |    two robots per
//   block, warps        | warp 0     | warp 1     | warp 2     | warp 3     | warp 4     | warp 5     |    three warps
//   each tiles        | 0  1  2    | 3  4  5    | 6  7  8  9 | 0  1  2    | 3  4  5    | 6  7  8  9 |
//
//   shared memory, from its first byte to `total`:
//   +-----------------+----------+--------------+-----------+-----------+-----------+-----------+
//   | material tables | failures | rest lengths | contacts  | brains    | tiles     | tiles     |
//   | one, or one per | one per  | one table    | one list  | one per   | of the    | of the    |
//   | robot; copies   | robot    | per robot    | per robot | robot     | first     | second    |
//   +-----------------+----------+--------------+-----------+-----------+-----------+-----------+
//                                  if records    if any      if any      working memory (tile.h)
//                                  have one word
//
//   After the rest lengths come the relaxation times of the materials if springs have any, one table, or one per robot.
//
// 1. A launch carries its robots through many steps. Masses stay in shared memory all the while; only spring records
//    and face pairs come from the L2 cache, once per step.
// 2. A warp needs the parameters of 32 materials at once, which would often lie in the same banks. So the block keeps
//    up to 16 copies of the material table, interleaved, and each lane reads a copy of its own: copy (lane mod
//    copies). With 16 copies there are no conflicts, since a read of 8 bytes serves half a warp per pass.
//    launch_configuration.cpp weighs them against memory to cache with.
// 3. What does not fit stays in device memory: the valences; or else the contacts; or both; or all working memory.
//    In the last case the blocks of a cluster step the robot in parts, if they can (parts.h); a block then has one
//    part.
// 4. Robots of a block that share a table wait for each other at each barrier, since one warp writes it for all. With
//    tables of their own, and without contacts, they are apart: each waits for its own warps alone, by a named barrier.
// 5. All sums are integers (springs.cuh), so neither the number of warps nor the other robots change a bit of the
//    result.
#pragma once

#include <algorithm>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "mercury/configuration.h"
#include "mercury/host_device.h"
#include "mercury/robot.h"
#include "sim/cuda/launch_configuration.h"
#include "sim/cuda/layout.h"

namespace mercury::cuda {

// The parameters of a material's springs in the current step.
template <Solver solver>
struct SpringParameters;
template <>
struct alignas(8) SpringParameters<Solver::force> {
  float stiffness;      // [N/m]
  float length_factor;  // L(t) / L0
};
template <>
struct alignas(8) SpringParameters<Solver::xpbd> {
  float compliance;     // 1/(k dt^2) [1/kg]
  float length_factor;  // L(t) / L0
};
inline constexpr std::uint32_t parameter_bytes = 8;
static_assert(sizeof(SpringParameters<Solver::force>) == parameter_bytes);
static_assert(sizeof(SpringParameters<Solver::xpbd>) == parameter_bytes);

inline constexpr std::uint32_t max_chunks = max_materials / lanes;

// Ends of the parts of shared memory [bytes].
struct BlockLayout {
  std::uint32_t tables, failures, lengths, relaxation_times, contacts, brains, total;
};

// Pairs within this distance are listed [m]: half as far again as they touch, but short of the diagonals of a lattice's
// faces, which springs join.
inline float list_radius(float contact_distance, float shortest_rest_length) {
  return std::max(1.25f * contact_distance, std::min(1.54f * contact_distance, 1.386f * shortest_rest_length));
}

// Buckets of the cell grid that finds the contacts of a robot of this many tiles; 0 without contacts.
inline std::uint32_t contact_buckets(const Environment& environment, std::uint32_t tiles) {
  return has_contacts(environment) ? std::bit_ceil(tiles * lanes) : 0;
}

// Bytes of ContactMemory (contacts.cuh): the list, and the grid of a robot of this many tiles. Before the list of a
// robot in parts come two votes.
inline constexpr std::uint32_t contact_vote_bytes = 8;
MERCURY_HOST_DEVICE std::uint32_t contact_list_bytes(const LaunchConfiguration& launch) {
  return (1 + launch.listed_pairs) * 4;
}
MERCURY_HOST_DEVICE std::uint32_t contact_grid_bytes(std::uint32_t buckets, std::uint32_t tiles) {
  return buckets * 4 + tiles * lanes * 2;
}
MERCURY_HOST_DEVICE std::uint32_t contact_bytes(const LaunchConfiguration& launch, std::uint32_t tiles) {
  if (launch.contact_buckets == 0) return 0;
  return contact_list_bytes(launch) + contact_grid_bytes(launch.contact_buckets, tiles);
}

// Pairs that the grid finds, joined or not, are written down until there are this many per slot.
inline constexpr std::uint32_t near_pairs_per_slot = 9;

// Bytes in device memory that ContactPass needs beside them.
inline std::uint32_t contact_workspace_bytes(std::uint32_t tiles) {
  return tiles * lanes * (3 * sizeof(float) + near_pairs_per_slot * sizeof(std::uint32_t));
}
// The same for a robot in parts of `part_tiles` each, with the grid, which all parts share.
inline std::size_t contact_workspace_bytes_in_parts(std::uint32_t buckets, std::uint32_t tiles, std::uint32_t parts,
                                                    std::uint32_t part_tiles) {
  return contact_grid_bytes(buckets, tiles) +
         lanes * (tiles * 3 * sizeof(float) + parts * part_tiles * near_pairs_per_slot * sizeof(std::uint32_t));
}

// `tiles` = of the largest robot, `fields` = of a tile in working memory.
MERCURY_HOST_DEVICE BlockLayout block_layout(const LaunchConfiguration& launch, std::uint32_t tiles,
                                             std::uint32_t fields) {
  BlockLayout layout{};
  const std::uint32_t tables = launch.shared_table ? 1 : launch.robots_per_block;
  layout.tables = (tables * launch.table_chunks * lanes * parameter_bytes) << launch.table_copy_bits;
  // And the steps of the next thoughts, and which materials move.
  layout.failures = layout.tables + (launch.robots_per_block * 12 + tables * max_chunks * 4 + 15) / 16 * 16;
  layout.lengths = layout.failures + (launch.record_words == 1 ? launch.robots_per_block * max_lengths * 4 : 0);
  layout.relaxation_times = layout.lengths + (launch.viscous ? tables * launch.table_chunks * lanes * 4 : 0);
  layout.contacts = layout.relaxation_times;
  if (launch.parts > 1 && launch.contact_buckets > 0)
    layout.contacts += contact_vote_bytes + contact_list_bytes(launch);
  else if (launch.contacts_on_chip)
    layout.contacts += launch.robots_per_block * contact_bytes(launch, tiles);
  layout.brains = layout.contacts + launch.robots_per_block * launch.brain.total();
  layout.total = layout.brains;
  if (launch.on_chip) layout.total += launch.robots_per_block * tiles * fields * field_bytes;
  return layout;
}

}  // namespace mercury::cuda
