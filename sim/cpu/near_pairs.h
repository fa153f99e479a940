// SPDX-License-Identifier: Apache-2.0
// Masses of one robot that are near each other without a spring between them.
//
// The list holds every pair within a margin more than the contact distance. It is made anew only when some mass may
// have moved so far that it could miss a pair; whenever that is, the pairs that touch are the same, and so are their
// sums.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "mercury/vec3.h"
#include "sim/cpu/aligned.h"
#include "sim/cpu/places.h"

namespace mercury::cpu {

// Pairs within this many contact distances are listed.
inline constexpr float list_radius = 2;
// How far a mass may go, measured from where the whole robot went, before the list is made anew: half the margin, less
// a percent for rounding. In contact distances.
inline constexpr float list_reach = 0.99f * (list_radius - 1) / 2;

class NearPairs {
 public:
  struct Pair {
    std::uint32_t i, j;  // places
  };

  NearPairs() = default;
  NearPairs(const Robot& robot, const Places& places);

  // Lists the pairs of the masses at these places, coordinates x, y, z, which a grid finds.
  void list(std::span<const float> x, std::span<const float> y, std::span<const float> z, float contact_distance);
  void forget() { listed_ = false; }

  // The other way, for robots of few masses: the caller looks at all pairs, many at once (sim/cpu/near_search.h), and
  // adds those that are near.
  bool few() const { return masses_.size() <= 64 * lanes_; }
  // For each place, for each block of places: one bit a lane, set where the mass at it comes later and no spring joins
  // the two. So many bytes a block.
  std::span<const std::uint8_t> candidates();
  static constexpr std::size_t bytes_of(std::size_t lanes) { return lanes > 8 ? 2 : 1; }
  void start(std::span<const float> x, std::span<const float> y, std::span<const float> z);
  void add(Pair pair) { pairs_.push_back(pair); }

  bool listed() const { return listed_; }
  std::uint64_t times_listed() const { return times_listed_; }
  std::span<const Pair> pairs() const { return pairs_; }
  // Where the masses were when the list was made.
  const Aligned<float>& x() const { return x_; }
  const Aligned<float>& y() const { return y_; }
  const Aligned<float>& z() const { return z_; }

 private:
  bool joined(std::uint32_t i, std::uint32_t j) const;
  struct Grid;
  void list_in_row(const Grid& grid, std::uint32_t i, std::uint32_t first, std::uint32_t last, float squared_radius);

  std::vector<std::uint32_t> masses_;          // places with a mass
  std::vector<std::uint32_t> start_, joined_;  // places joined by a spring to place i: [start_[i], start_[i + 1])
  std::vector<Pair> pairs_;
  std::size_t lanes_ = 1;
  std::vector<std::uint8_t> candidates_;  // made when first asked for
  Aligned<float> x_, y_, z_;
  bool listed_ = false;
  std::uint64_t times_listed_ = 0;
};

}  // namespace mercury::cpu
