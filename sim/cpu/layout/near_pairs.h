// SPDX-License-Identifier: Apache-2.0
// The search for near pairs: masses of one robot that may touch, though no spring joins them.
//
//   mass i          d                   2 d             d: contact distance
//     o-------------|-------------------|---------->
//        touches i    listed with i,      not listed
//                     does not touch
//
// 1. Two masses repel within the contact distance d, but the list holds all pairs within list_radius * d. As long as
//    no mass has moved more than half of the margin, every pair that touches is in the list.
// 2. Moves are measured relative to the first mass: a robot that travels as a whole keeps its list.
// 3. Searching again sooner or later changes the list, not the pairs in it that touch; sums of integers do not depend
//    on their order. So the search may depend on how robots are grouped, and trajectories still do not.
// 4. A robot of few masses is searched by comparing all pairs, a tile at a time (kernels/near_search.h). One bit per
//    pair says in advance whether the pair counts: once, and only without a spring.
// 5. A larger robot is searched with a grid of cells that are at least as wide as the search radius. Masses are sorted
//    by cell, x fastest, so that neighboring cells along x are one stretch of the list. A mass in row * is compared
//    with those after it in its own row, and with rows 1 to 4, so that each pair is met once:
//
//      z + 1   | 2 | 3 | 4 |      rows of cells, seen along the x axis
//      z       |   | * | 1 |
//      z - 1   |   |   |   |
//               y-1  y  y+1
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "mercury/vec3.h"
#include "sim/cpu/layout/aligned.h"
#include "sim/cpu/layout/slots.h"

namespace mercury::cpu {

// Pairs within this many contact distances are listed.
inline constexpr float list_radius = 2;
// How far a mass may move, relative to the first mass, before the search must run again, in contact distances: half of
// the margin, less a percent for rounding.
inline constexpr float list_reach = 0.99f * (list_radius - 1) / 2;

class NearPairs {
 public:
  struct Pair {
    std::uint32_t i, j;  // slots
  };

  NearPairs() = default;
  NearPairs(const Robot& robot, const Slots& slots);

  // Lists the near pairs of masses at these coordinates, by slot, with a grid.
  void search_grid(std::span<const float> x, std::span<const float> y, std::span<const float> z,
                   float contact_distance);
  void forget() { listed_ = false; }

  // Whether the robot is small enough to compare all pairs. Then the caller calls start() and add()s what it finds.
  bool few() const { return masses_.size() <= 64 * lanes_; }
  // [slot i][tile][bytes_per_tile()]: one bit per lane, set if the mass j in that lane counts as candidate: j > i and
  // no spring joins the two.
  std::span<const std::uint8_t> candidates();
  static constexpr std::size_t bytes_per_tile(std::size_t lanes) { return lanes > 8 ? 2 : 1; }
  void start(std::span<const float> x, std::span<const float> y, std::span<const float> z);
  void add(Pair pair) { pairs_.push_back(pair); }

  bool is_prepared() const { return !start_.empty(); }
  bool listed() const { return listed_; }
  std::uint64_t searches() const { return searches_; }  // identifies a list
  std::span<const Pair> pairs() const { return pairs_; }
  // Positions at the last search, by slot.
  const Aligned<float>& x() const { return x_; }
  const Aligned<float>& y() const { return y_; }
  const Aligned<float>& z() const { return z_; }

 private:
  bool joined(std::uint32_t i, std::uint32_t j) const;
  struct Grid;
  void add_near_of(const Grid& grid, std::uint32_t i, std::uint32_t first, std::uint32_t last, float squared_radius);

  std::vector<std::uint32_t> masses_;  // slots with a mass
  std::vector<std::uint32_t> start_,
      joined_;  // springs join slot i with joined_[start_[i]] to joined_[start_[i + 1] - 1]
  std::vector<Pair> pairs_;
  std::size_t lanes_ = 1;
  std::vector<std::uint8_t> candidates_;  // computed at the first request
  Aligned<float> x_, y_, z_;
  bool listed_ = false;
  std::uint64_t searches_ = 0;
};

}  // namespace mercury::cpu
