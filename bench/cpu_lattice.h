// SPDX-License-Identifier: Apache-2.0
// The robot that the CPU is measured with: a lattice of n x n x n voxels, every spring of a random material.
#pragma once

#include <cstdint>

#include "mercury/robot.h"

namespace mercury::bench {

// (n + 1)^3 masses, x fastest, 0.1 m apart; springs between all masses of a voxel; two triangles a side of the skin.
// n = 10: 1,331 masses, 14,230 springs, 1,200 faces.
Robot lattice(int n);

// The same without a share of its voxels, as grown bodies are: what no voxel needs is left out. Another seed leaves out
// others.
Robot lattice_with_holes(int n, double share, std::uint64_t seed = 1);

// The same with masses numbered in any order, so that nothing follows one another.
Robot scrambled(const Robot& robot, std::uint64_t seed = 3);

}  // namespace mercury::bench
