// SPDX-License-Identifier: Apache-2.0
// Which of its two masses owns each spring. The owner's lane computes the spring.
//
// A tile needs as many rows as its busiest lane or bank has springs (schedule.cpp). A spring loads two counters:
// the lane of its owner, and in the owner's tile the bank of its partner. If the other mass owns it, it loads two
// others:
//
//   spring 5 - 70   owned by 5:    lane 5 of tile 0,   bank 70 mod 32 = 6 of tile 0
//                   owned by 70:   lane 6 of tile 2,   bank 5 of tile 2
//
// 1. A first choice takes springs in turn and gives each to the mass whose two counters have less. Two sweeps over all
//    springs then give springs to their other mass where that evens out the loads.
// 2. What remains are peaks. Tile after tile, the limit of the tile's counters is lowered by one. A counter above it
//    gives away a spring. If that puts one of the spring's new counters above its limit, this one gives away a spring
//    in turn, and so on: a breadth-first search finds the shortest such chain (an augmenting path). Where there is
//    none, the tile keeps its limit, and is done.
// 3. A row of the last tile has fewer springs than one of another tile, if that tile is partly empty. So its masses own
//    as few springs as possible: the search prefers their partners, and lowers the limit of the last tile first.
// 4. A robot of one tile may have masses that join to most others, as the middle of 2 x 2 x 2 voxels does: all rows are
//    waiting for them. Their banks count as two or four, in turn by the lane of the owner. So as many lanes of a row
//    may have such a mass as their partner: they read it in one pass, and add to its sum one after another, which takes
//    less time than more rows.
// 5. A warp computes four rows at a time (rows_at_once). So limits become multiples of four where the sum of all limits
//    allows it, by further chains.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "sim/cuda/tile.h"

namespace mercury::cuda {

struct OwnedSpring {
  std::uint16_t owner, partner;  // slots
};

// Counters of a tile: its 32 lanes, its 32 banks, and those that masses have beyond one.
inline constexpr std::uint32_t most_extra_banks = 15, tile_counters = 2 * lanes + most_extra_banks;
constexpr std::uint32_t lane_counter(std::uint32_t owner) { return owner / lanes * tile_counters + owner % lanes; }

// How many banks the masses of a robot count as: one each, if it has several tiles.
class MassBanks {
 public:
  MassBanks() = default;
  MassBanks(std::size_t masses, std::span<const OwnedSpring> springs);

  std::uint32_t count(std::uint32_t slot) const { return others_[slot % lanes] + 1u; }
  // That of a spring's partner which its owner uses.
  std::uint32_t bank_of(OwnedSpring s) const {
    const std::uint32_t first = s.partner % lanes;
    if (!has_others_) return first;  // as in nearly all robots
    const std::uint32_t other = s.owner & others_[first];
    return other == 0 ? first : before_others_[first] + other;
  }
  std::uint32_t bank_counter(OwnedSpring s) const { return s.owner / lanes * tile_counters + lanes + bank_of(s); }

 private:
  bool has_others_ = false;
  std::array<std::uint8_t, lanes> others_{}, before_others_{};  // [bank], 0, 1 or 3 others, which follow this one
};

struct OwnedSprings {
  std::vector<OwnedSpring> springs;  // by their number
  MassBanks banks;
  std::vector<std::uint32_t> rows;  // by tile: as many as its busiest lane or bank has springs, or up to three more
  // The numbers of the springs that load counter c, or would if their other mass owned them:
  // candidates[first_candidate[c] .. first_candidate[c + 1]).
  std::vector<std::uint32_t> first_candidate, candidates;

  // The numbers of the springs that join a slot to others.
  std::span<const std::uint32_t> springs_at(std::uint32_t slot) const {
    const std::uint32_t first = first_candidate[lane_counter(slot)], end = first_candidate[lane_counter(slot) + 1];
    return std::span(candidates).subspan(first, end - first);
  }
};

// Exchanges the ends of springs, so that the tiles need few rows in all. Slots after the tiles of the masses are of
// ghosts (parts.h), which own no springs: they are partners from the start, and stay so.
OwnedSprings choose_owners(std::size_t masses, std::vector<OwnedSpring> springs, std::size_t ghosts = 0);

}  // namespace mercury::cuda
