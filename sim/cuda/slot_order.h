// SPDX-License-Identifier: Apache-2.0
// Which slot each mass of a robot stands in.
//
//   masses by valence   | 26 26 26 ... 25 | 25 24 24 ... 20 | 19 19 17 ... 13 | 11 9 7 |   32 per tile
//   tiles by warp       | the first and the fourth           | the second and the third |   two per warp here
//   lanes               each mass of a tile takes the lane whose bank is least busy
//
// 1. A lane of a tile computes about half of the springs of its mass, and a tile takes as many rows as its busiest lane
//    has springs (schedule.h). So masses of about the same valence share a tile.
// 2. A warp computes consecutive tiles, and the robot waits for its last warp. So heavy tiles and light ones are dealt
//    out to the warps.
// 3. A row uses each bank once. So the springs of a tile should lead to masses in all banks alike: a mass takes the
//    free lane of its tile whose bank the tiles of its neighbors have used least so far. The corners of faces should
//    also lie in all banks alike (face_tiles.h), and count in the same way.
#pragma once

#include <algorithm>
#include <cstdint>
#include <span>
#include <vector>

#include "mercury/robot.h"
#include "sim/cuda/tile.h"
#include "sim/physics/face_pairs.h"

namespace mercury::cuda {

// A permutation: `masses` masses stand in the slots 0 .. masses - 1. Ghosts begin a tile of their own, so that slots
// may be empty before them.
struct SlotOrder {
  std::vector<std::uint16_t> slots;  // [mass]

  std::uint32_t slot_of(std::uint32_t mass) const { return slots[mass]; }
  // Pairs of masses, by their slots, in a vertex order that follows from the slots alone. Robots of one topology share
  // an arrangement. Forces on faces of real bodies are rounded by the place of their pair in it, and by which of the
  // two is the first. So pairs in the order of the rest positions would let a robot move as another one, of another
  // shape, has arranged it.
  std::vector<FacePair> placed(std::span<const FacePair> pairs) const;
  std::vector<std::uint16_t> masses() const {  // [slot], of empty ones 0
    std::vector<std::uint16_t> inverse(slots.empty() ? 0 : std::ranges::max(slots) + std::size_t{1});
    for (std::size_t mass = 0; mass < slots.size(); ++mass) inverse[slots[mass]] = static_cast<std::uint16_t>(mass);
    return inverse;
  }
};

// `pairs` = pair_faces(robot). The order follows from the topology alone. The last `ghosts` masses are ghosts
// (parts.h).
SlotOrder choose_slots(const Robot& robot, std::span<const FacePair> pairs, std::uint32_t ghosts = 0);

// Positions for tiles whose work is given in descending order, so that warps which share them (first_tile_of()) have
// about the same work. The last tile stays last, because it may be partly empty. No more warps than tiles.
std::vector<std::uint32_t> deal_tiles(std::span<const std::uint32_t> work, std::uint32_t warp_count);

}  // namespace mercury::cuda
