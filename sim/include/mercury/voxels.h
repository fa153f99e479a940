// SPDX-License-Identifier: Apache-2.0
// The voxels of a robot, found by its masses and springs.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "mercury/material.h"
#include "mercury/robot.h"

namespace mercury {

// A cube whose 8 corners are masses, joined by all 28 springs.
struct Voxel {
  std::array<std::uint16_t, 8> corners{};  // x fastest, then y, then z
  MaterialId material = 0;                 // of a spring through its middle
};

struct Voxels {
  std::vector<Voxel> all;
  float edge = 0;             // [m]
  bool shares_pairs = false;  // some pair of masses has several springs, as in real bodies of several materials
};

// Empty unless all masses stand on one lattice, and every spring joins two corners of a voxel.
Voxels voxels_of(const Robot& robot);

// Calls visit(i, j) for the 28 pairs of corners.
template <class Visit>
void for_each_pair_of_corners(const Visit& visit) {
  for (std::size_t i = 0; i < 8; ++i)
    for (std::size_t j = i + 1; j < 8; ++j) visit(i, j);
}

// Names a pair of masses, in either order.
inline std::uint32_t pair_of(std::uint32_t a, std::uint32_t b) { return a < b ? a << 16 | b : b << 16 | a; }

}  // namespace mercury
