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
//   | material tables | records  | rest lengths | contacts  | brains    | tiles     | tiles     |
//   | one, or one per | one per  | one table    | one grid  | one per   | of the    | of the    |
//   | robot; copies   | robot    | per robot    | per robot | robot     | first     | second    |
//   +-----------------+----------+--------------+-----------+-----------+-----------+-----------+
//                                  if springs'   if any, of  if any      working memory (tile.h)
//                                  records have  large
//                                  one word      robots
//
//   Before the material tables come their barriers, two per table.
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
// 4. Without contacts, robots of a block are apart: each waits for its own warps alone, by a named barrier. If they
//    share a table, no one is ahead by a whole step (material_table.cuh). With contacts, all wait for each other;
//    those that share no table have blocks of their own, if there is room.
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

// Of a material table's two barriers.
inline constexpr std::uint32_t table_barrier_bytes = 16;
// Of a RobotRecord (thread_context.cuh).
inline constexpr std::uint32_t robot_record_bytes = 40;

// Ends of the parts of shared memory [bytes].
struct BlockLayout {
  std::uint32_t barriers, tables, records, lengths, relaxation_times, contacts, brains, total;
};

// Pairs within this distance are listed [m]: short of the diagonals of a lattice's faces, so that springs join few of
// them, but farther than they touch.
inline float list_radius(float contact_distance, float shortest_rest_length) {
  return std::max(1.25f * contact_distance, 1.386f * shortest_rest_length);
}

// Buckets of the cell grid that finds the contacts of a robot of this many tiles; 0 without contacts.
inline std::uint32_t contact_buckets(const Environment& environment, std::uint32_t tiles) {
  return has_contacts(environment) ? std::bit_ceil(tiles * lanes) : 0;
}

// Bytes of the cell grid of a robot of this many tiles (contacts.cuh): ends of buckets, sums of warps, sorted slots.
MERCURY_HOST_DEVICE std::uint32_t contact_grid_bytes(std::uint32_t buckets, std::uint32_t tiles) {
  return buckets > 0 ? (buckets + lanes) * 4 + tiles * lanes * 2 : 0;
}

// Robots of at most this many tiles have no grid: all of their masses are compared with each other.
inline constexpr std::uint32_t most_compared_tiles = 16;

// Pairs that the grid finds are written down, joined or not, and then listed, until there are this many per slot.
inline constexpr std::uint32_t near_pairs_per_slot = 9;

// Bytes in device memory that ContactPass needs: where masses were listed, both kinds of pairs, and how many are
// listed. Robots without a grid have a bit per pair of slots in place of the first kind. Of a robot in parts of
// `part_tiles` each, with the grid, which all parts share.
inline std::size_t contact_workspace_bytes(std::uint32_t tiles) {
  const std::uint32_t words_per_slot =
      tiles > most_compared_tiles ? 2 * near_pairs_per_slot : tiles + near_pairs_per_slot;
  return std::size_t{tiles} * lanes * (3 * sizeof(float) + words_per_slot * sizeof(std::uint32_t)) +
         sizeof(std::uint32_t);
}
inline std::size_t contact_workspace_bytes_in_parts(std::uint32_t buckets, std::uint32_t tiles, std::uint32_t parts,
                                                    std::uint32_t part_tiles) {
  return contact_grid_bytes(buckets, tiles) + std::size_t{lanes} * tiles * 3 * sizeof(float) +
         parts * (std::size_t{lanes} * part_tiles * 2 * near_pairs_per_slot + 1) * sizeof(std::uint32_t);
}

// `tiles` = of the largest robot, `fields` = of a tile in working memory.
MERCURY_HOST_DEVICE BlockLayout block_layout(const LaunchConfiguration& launch, std::uint32_t tiles,
                                             std::uint32_t fields) {
  BlockLayout layout{};
  const std::uint32_t tables = launch.shared_table ? 1 : launch.robots_per_block;
  layout.barriers = tables * table_barrier_bytes;
  layout.tables =
      layout.barriers + ((tables * launch.table_chunks * lanes * parameter_bytes) << launch.table_copy_bits);
  // And the steps of the next thoughts, and which materials move.
  layout.records =
      layout.tables + (launch.robots_per_block * (robot_record_bytes + 4) + tables * max_chunks * 4 + 15) / 16 * 16;
  layout.lengths = layout.records + (launch.record_words == 1 ? launch.robots_per_block * max_lengths * 4 : 0);
  layout.relaxation_times = layout.lengths + (launch.viscous ? tables * launch.table_chunks * lanes * 4 : 0);
  layout.contacts = layout.relaxation_times;
  if (launch.parts == 1 && launch.contacts_on_chip && tiles > most_compared_tiles)
    layout.contacts += launch.robots_per_block * contact_grid_bytes(launch.contact_buckets, tiles);
  layout.brains = layout.contacts + launch.robots_per_block * launch.brain.total();
  layout.total = layout.brains;
  if (launch.on_chip) layout.total += launch.robots_per_block * tiles * fields * field_bytes;
  return layout;
}

}  // namespace mercury::cuda
