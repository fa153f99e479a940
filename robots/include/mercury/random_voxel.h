// SPDX-License-Identifier: Apache-2.0
// Random voxel robots: rounded bodies of patches of muscle, tissue and bone (paper, figure 1).
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "mercury/voxel.h"

namespace mercury {

enum class Mirror { none, x, y, z };  // the axis along which the two halves face each other

inline constexpr int voxel_frequencies = 5;  // of the base muscles

struct RandomVoxelOptions {
  std::array<int, 3> smallest{4, 3, 3};  // voxels; each robot's size is drawn between the two, both included
  std::array<int, 3> largest{7, 5, 4};
  float edge = 0.1f;          // of a voxel [m]
  double air = 0.3;           // share of the grid's voxels that are air, before loose parts are dropped
  Mirror mirror = Mirror::y;  // a robot whose halves differ swims in circles
  int patch = 2;              // size of the regions of one material [voxels]; 1 = each voxel is drawn by itself
  double muscle = 0.75;       // shares of muscle, tissue and bone among the regions; only their ratios count
  double tissue = 0.17;
  double bone = 0.08;
  int frequencies = 1;      // how many of the five muscle frequencies one robot uses
  std::string environment;  // where the robots belong ("ocean"), kept in their origin; empty = not recorded
};

// Throws ParameterError("air", ...) and so on unless sizes, patch and frequencies (at most 5) are at least 1,
// 0 <= air < 1, the edge is at least min_rest_length, and the shares are finite, at least 0 and not all 0.
void validate(const RandomVoxelOptions& options);

// The grid of the index-th robot of a seed. It depends on options, seed and index alone, bit for bit on every machine.
// Throws ParameterError as validate.
VoxelGrid random_voxel_grid(const RandomVoxelOptions& options, std::uint64_t seed, std::uint64_t index = 0);

// The robot of that grid, "voxel-SEED-INDEX"; its origin keeps seed and index. Throws InputError, too, for a body of
// more than max_masses masses.
Robot random_voxel_robot(const RandomVoxelOptions& options, std::uint64_t seed, std::uint64_t index = 0);

// Robots first .. first + count - 1 of a seed, made on all cores. Throws the first error of random_voxel_robot.
std::vector<Robot> random_voxel_robots(const RandomVoxelOptions& options, std::uint64_t seed, std::size_t count,
                                       std::uint64_t first = 0);

}  // namespace mercury
