// SPDX-License-Identifier: Apache-2.0
// The cells of a Delaunay triangulation while it is built.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "robots/nn/tetrahedra.h"

namespace mercury::delaunay {

inline constexpr std::uint32_t infinite = 0xffffffff;  // the vertex at infinity
inline constexpr std::uint32_t none = 0xffffffff;      // no cell

struct Cell {
  Tetrahedron corners;                     // of positive orientation; one may be infinite
  std::array<std::uint32_t, 4> neighbors;  // neighbor i is opposite to corner i
};

// 4 = no corner
inline std::size_t corner_at_infinity(const Cell& cell) {
  std::size_t i = 0;
  while (i < 4 && cell.corners[i] != infinite) ++i;
  return i;
}

// Position of a value that is in the list, without a branch.
inline std::uint32_t position_of(std::uint32_t value, const std::array<std::uint32_t, 4>& in) {
  const std::uint32_t is_1 = in[1] == value, is_2 = in[2] == value, is_3 = in[3] == value;
  return (is_1 | is_3) + 2 * (is_2 | is_3);
}

// The edges of the side opposite to a corner, all in the same sense of rotation, each with the third corner of the
// side.
struct EdgeOfSide {
  std::uint32_t opposite, from, to;
};
inline constexpr EdgeOfSide edges_of_side[4][3] = {{{1, 2, 3}, {2, 3, 1}, {3, 1, 2}},
                                                   {{0, 3, 2}, {3, 2, 0}, {2, 0, 3}},
                                                   {{0, 1, 3}, {1, 3, 0}, {3, 0, 1}},
                                                   {{0, 2, 1}, {2, 1, 0}, {1, 0, 2}}};

}  // namespace mercury::delaunay
