// SPDX-License-Identifier: Apache-2.0
// The schedule of springs: the order in which a warp computes the springs of its tiles.
//
// One of a spring's two masses owns it, and the owner's lane computes it. The other mass is its partner: the lane reads
// the partner's position and adds the reaction to the partner's sum. A row holds at most one spring per lane, and a
// warp computes a row at a time:
//
//              lane 0      lane 1      lane 2     ...    lane 31
//   row 0    |  0 -> 40  |  1 -> 65  |  2 -> 3   | ... |  31 -> 32  |    banks of the partners:  8   1   3  ...   0
//   row 1    |  0 -> 1   |  1 -> 34  |  padding  | ... |  31 -> 63  |                            1   2  any ...  31
//   ...                                                                         in a row all different
//
// 1. Shared memory serves 32 lanes in one pass if their words lie in different banks. So no two partners of a row
//    share a bank, but for masses that count as several (spring_owners.h). The owners of a row stand in the 32 lanes
//    of one tile, so they never do.
// 2. A row of springs waits for its slowest lane, so a tile should have few rows. Rows are the colors of an edge
//    coloring (schedule.cpp), which needs as many as the busiest lane or bank has springs. Owners are chosen to
//    keep that number small (spring_owners.h).
// 3. A lane's own mass stays in registers for all its rows. Only the partner's position and sum go through shared
//    memory.
// 4. Padding fills the unused entries. It is computed like a spring (of air, so it adds nothing) and reads a partner
//    too. That partner lies in a bank that the row leaves free: the owner itself or a mass near it, so that its
//    distance is an ordinary one.
#pragma once

#include <cstdint>
#include <vector>

#include "sim/cuda/spring_owners.h"

namespace mercury::cuda {

// ScheduledSpring::spring of an unused entry.
inline constexpr std::uint32_t padding = 0xffffffffu;

// An entry of the schedule. Its owner is the slot of its lane.
struct ScheduledSpring {
  std::uint32_t spring = padding;  // its number
  std::uint16_t partner = 0;       // slot
};

struct Schedule {
  // Rows of tile t are [row_start[t], row_start[t + 1]); row r has the entries [32 r, 32 r + 32).
  std::vector<std::uint32_t> row_start;
  std::vector<ScheduledSpring> entries;
  // [slot] the springs that join it to others, and the entries whose partner it is, padding included.
  std::vector<std::uint32_t> valences, incoming_counts;
  std::uint32_t tiles() const { return static_cast<std::uint32_t>(row_start.size() - 1); }
  std::uint32_t rows() const { return row_start.back(); }
  std::uint32_t rows_of(std::uint32_t tile) const { return row_start[tile + 1] - row_start[tile]; }
};

// `springs` by their number; which end is the owner may change. Slots are below `masses`, or belong to ghosts, which
// choose_owners() explains. Tiles of ghosts have no rows.
Schedule schedule_springs(std::size_t masses, std::vector<OwnedSpring> springs, std::size_t ghosts = 0);

}  // namespace mercury::cuda
