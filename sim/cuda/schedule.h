// SPDX-License-Identifier: Apache-2.0
// The order in which a warp meets its springs, so that its 32 lanes never want the same bank of shared memory.
//
// Masses stand in groups of 32, one a lane. Each spring is owned by one of its two masses, whose lane computes it; the
// other mass is its partner. In one row every lane of a group has at most one spring, and no two partners share a bank
// (mass index mod 32). Rows are found by colouring the edges of the bipartite graph of lanes and banks, which takes
// exactly as many rows as the busiest lane or bank has springs (Koenig's theorem); owners are chosen to keep that
// small.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "mercury/robot.h"
#include "sim/physics/face_pairs.h"

namespace mercury::cuda {

inline constexpr std::uint32_t lanes = 32;

// A spring as its owner's lane sees it. An empty place looks at a mass in a bank that nobody else in the row wants: a
// neighbour of the owner, else any.
inline constexpr std::uint32_t no_spring = 0xffffffffu;
struct ScheduledSpring {
  std::uint32_t spring = no_spring;  // its number
  std::uint16_t partner = 0;
};

struct Schedule {
  // Rows of group g are [row_start[g], row_start[g + 1]); a row has 32 places.
  std::vector<std::uint32_t> row_start;
  std::vector<ScheduledSpring> places;
  std::uint32_t groups() const { return static_cast<std::uint32_t>(row_start.size() - 1); }
  std::uint32_t rows() const { return row_start.back(); }
};

Schedule schedule_springs(std::size_t masses, std::span<const Spring> springs);

// An empty place.
inline constexpr FacePair no_faces{0, 0, 0, 0};

// Accesses that pairs need at least in a column, for what they want of the bank that they want most.
std::uint32_t busiest_bank(std::span<const FacePair> pairs);

// The same pairs in another order, each perhaps told from another corner, in as few bundles of 32 as there can be, the
// last filled up with empty places. Few of a bundle have masses of the same bank in the same column: those wait for
// each other, which costs less than another bundle would.
std::vector<FacePair> spread_over_banks(std::span<const FacePair> pairs);

}  // namespace mercury::cuda
