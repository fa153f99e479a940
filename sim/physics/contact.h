// SPDX-License-Identifier: Apache-2.0
// Cells of one contact distance, hashed into buckets that list their masses: finding the pairs that touch costs a few
// look-ups a mass instead of one for every other mass. Lists stand in any order; sums are integers, so it has no
// effect.
#pragma once

#include <cstdint>

#include "mercury/host_device.h"
#include "mercury/vec3.h"

namespace mercury {

inline constexpr std::uint16_t end_of_list = 0xffff;

struct Cell {
  std::int32_t x, y, z;
  friend MERCURY_HOST_DEVICE bool operator==(Cell a, Cell b) { return a.x == b.x && a.y == b.y && a.z == b.z; }
};

MERCURY_HOST_DEVICE std::int32_t cell_coordinate(float x, float inverse_size) {
  constexpr float most = 1e9f;
  const float scaled = std::floor(x * inverse_size);
  return static_cast<std::int32_t>(!(scaled > -most) ? -most : scaled > most ? most : scaled);  // NaN as well
}

MERCURY_HOST_DEVICE Cell cell_of(Vec3 x, float inverse_size) {
  return {cell_coordinate(x.x, inverse_size), cell_coordinate(x.y, inverse_size), cell_coordinate(x.z, inverse_size)};
}

// mask + 1 buckets, a power of two.
MERCURY_HOST_DEVICE std::uint32_t bucket_of(Cell cell, std::uint32_t mask) {
  const std::uint32_t h = static_cast<std::uint32_t>(cell.x) * 0x9e3779b1u +
                          static_cast<std::uint32_t>(cell.y) * 0x85ebca77u +
                          static_cast<std::uint32_t>(cell.z) * 0xc2b2ae3du;
  return (h ^ (h >> 15)) & mask;
}

// The cell itself and the 13 neighbours that come after it: with them every pair is met once.
inline constexpr int half_neighbourhood = 14;
MERCURY_HOST_DEVICE Cell neighbour_cell(Cell cell, int index) {
  const int code = 13 + index;  // (dx + 1) + 3 (dy + 1) + 9 (dz + 1); 13 is the cell itself
  return {cell.x + code % 3 - 1, cell.y + code / 3 % 3 - 1, cell.z + code / 9 - 1};
}

}  // namespace mercury
