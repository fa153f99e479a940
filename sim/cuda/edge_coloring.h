// SPDX-License-Identifier: Apache-2.0
// Colors the springs of each tile so that springs of one color share neither a lane nor a bank. A color becomes a
// row.
//
// The springs of a tile are the edges of a bipartite graph: on one side the 32 lanes of the owners, on the other the 32
// banks of the partners.
//
//   lanes      0    1    2   ...  31          spring: owner's lane -> partner's bank
//              | \  |  / |         |          edges that meet at a lane: the lane computes one spring per row
//              |  \ | /  |         |          edges that meet at a bank: one access per row and bank
//   banks      0    1    2   ...  31
//
// 1. Such a graph can be colored with as many colors as the busiest vertex has edges (Koenig's theorem). No
//    schedule has fewer rows.
// 2. Each vertex keeps the set of its free colors as bits. An edge takes the first bit of the intersection of its two
//    ends' sets.
// 3. If the intersection is empty, some color p is free at the lane and some other color q at the bank. Exchanging p
//    and q along the path of edges colored p, q, p, ... that starts at the bank frees p at the bank too. The path
//    never ends at the lane, because it enters lanes by edges of color p.
#pragma once

#include <cstdint>
#include <span>
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

// Rows of tile t are [row_start[t], row_start[t + 1]): as many as its busiest lane or bank has springs. Returns the
// entries of all rows, 32 per row.
std::vector<ScheduledSpring> color_springs(std::span<const OwnedSpring> springs,
                                           std::span<const std::uint32_t> row_start);

}  // namespace mercury::cuda
