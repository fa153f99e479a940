// SPDX-License-Identifier: Apache-2.0
// A grid that finds pairs of near masses. Its cells are as wide as the contact distance, so masses that touch are in
// the same cell or in neighbors. Cells are hashed into buckets, and each bucket lists its masses:
//
//   +---+---+---+
//   | o | o | o |     A mass looks at its own cell and at half of the neighbors (o: 13 of 26 in 3D).
//   +---+---+---+     The other half looks at it, so every pair is found once.
//   | . | x | o |
//   +---+---+---+     Other cells may share a bucket. The distance test rejects their masses.
//   | . | . | . |
//   +---+---+---+
//
// CUDA sorts masses by the same cells, in buckets of its own (sim/cuda/contacts.cuh).
#pragma once

#include <cstdint>

#include "mercury/host_device.h"
#include "mercury/vec3.h"

namespace mercury {

inline constexpr std::uint16_t end_of_list = 0xffff;

struct Cell {
  std::int32_t x, y, z;
  friend MERCURY_HOST_DEVICE bool operator==(Cell a, Cell b) { return a.x == b.x && a.y == b.y && a.z == b.z; }
  friend MERCURY_HOST_DEVICE Cell operator+(Cell a, Cell b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
};

MERCURY_HOST_DEVICE std::int32_t cell_coordinate(float x, float inverse_size) {
  constexpr float most = 1e9f;
  const float scaled = std::floor(x * inverse_size);
  return static_cast<std::int32_t>(!(scaled > -most) ? -most : scaled > most ? most : scaled);  // NaN gives -most
}

MERCURY_HOST_DEVICE Cell cell_of(Vec3 x, float inverse_size) {
  return {cell_coordinate(x.x, inverse_size), cell_coordinate(x.y, inverse_size), cell_coordinate(x.z, inverse_size)};
}

// The hash of a sum of cells is the sum of theirs.
MERCURY_HOST_DEVICE std::uint32_t hash_of(Cell cell) {
  return static_cast<std::uint32_t>(cell.x) * 0x9e3779b1u + static_cast<std::uint32_t>(cell.y) * 0x85ebca77u +
         static_cast<std::uint32_t>(cell.z) * 0xc2b2ae3du;
}
// There are mask + 1 buckets, a power of two.
MERCURY_HOST_DEVICE std::uint32_t bucket_of(std::uint32_t hash, std::uint32_t mask) {
  return (hash ^ (hash >> 15)) & mask;
}

// The cell itself (index 0) and the 13 neighbors after it.
inline constexpr int half_neighborhood = 14;
MERCURY_HOST_DEVICE Cell neighbor(int index) {
  const int code = 13 + index;  // (dx + 1) + 3 (dy + 1) + 9 (dz + 1); 13 is the cell itself
  return {code % 3 - 1, code / 3 % 3 - 1, code / 9 - 1};
}

}  // namespace mercury
