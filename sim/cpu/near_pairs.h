// Masses of one robot that are near each other without a spring between them.
//
// The list holds every pair within a margin more than the contact distance. It is made anew only when some mass may have
// moved so far that it could miss a pair; whenever that is, the pairs that touch are the same, and so are their sums.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "sim/cpu/aligned.h"
#include "sim/cpu/places.h"
#include "sim/vec3.h"

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

  // Lists the pairs of the masses at these places, coordinates x, y, z.
  void list(std::span<const float> x, std::span<const float> y, std::span<const float> z, float contact_distance);
  void forget() { listed_ = false; }

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

  std::vector<std::uint32_t> masses_;           // places with a mass
  std::vector<std::uint32_t> start_, joined_;   // places joined by a spring to place i: [start_[i], start_[i + 1])
  std::vector<Pair> pairs_;
  Aligned<float> x_, y_, z_;
  bool listed_ = false;
  std::uint64_t times_listed_ = 0;
};

}  // namespace mercury::cpu
