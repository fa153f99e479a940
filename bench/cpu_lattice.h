// SPDX-License-Identifier: Apache-2.0
// The robots that benchmarks step: lattices of n x n x n voxels with random materials.
#pragma once

#include <cstdint>

#include "mercury/robot.h"

namespace mercury::bench {

// (n + 1)^3 masses, x fastest, 0.1 m apart; springs between all masses of a voxel; two triangles per voxel side.
// n = 10: 1,331 masses, 14,230 springs, 1,200 faces.
Robot lattice(int n);

// The same without a share of its voxels, like grown bodies. Other seeds leave out other voxels.
Robot lattice_with_holes(int n, double share, std::uint64_t seed = 1);

// The same robot with its masses in random order.
Robot scrambled(const Robot& robot, std::uint64_t seed = 3);

}  // namespace mercury::bench
