// SPDX-License-Identifier: Apache-2.0
// Small robots of different topologies, which lockstep groups mix.
#pragma once

#include <cstdint>
#include <vector>

#include "bench/cpu_lattice.h"
#include "bodies.h"
#include "mercury/robot.h"

namespace mercury::test {

// More than two groups of robots for this number of lanes, no two with the same topology: voxels are missing, sizes
// differ, some have their masses in another order, some have materials of their own. One is no lattice.
inline std::vector<Robot> mixed_robots(std::size_t lanes) {
  std::vector<Robot> robots;
  for (std::uint64_t seed = 1; seed <= 2 * lanes + 3; ++seed) {
    const int n = seed % 5 == 0 ? 3 : 2;
    robots.push_back(bench::lattice_with_holes(n, 0.3, seed));
    Robot& robot = robots.back();
    if (seed % 3 == 0) robot = bench::scrambled(robot, seed);
    if (seed % 4 == 0) {
      robot.materials.assign(materials_of(robot).begin(), materials_of(robot).end());
      for (Material& material : robot.materials) {
        material.stiffness *= 1 + 0.01f * static_cast<float>(seed);
        material.phase += 0.1f * static_cast<float>(seed);
        material.half_wave = seed % 8 == 0;
      }
    }
  }
  robots.push_back(bodies::random_voxels({.x = 3, .y = 2, .z = 1}, 1));
  robots.push_back(bodies::random_voxels({.x = 1, .y = 1, .z = 1}, 2));
  bodies::rotate(robots[4], bodies::random_rotation(1));
  return robots;
}

// That many robots, of 1, 2, 3, ... x 2 x 2 voxels.
inline std::vector<Robot> growing_robots(std::size_t count) {
  std::vector<Robot> robots;
  for (std::uint64_t seed = 1; seed <= count; ++seed)
    robots.push_back(bodies::random_voxels({.x = static_cast<int>(seed), .y = 2, .z = 2}, seed));
  return robots;
}

}  // namespace mercury::test
