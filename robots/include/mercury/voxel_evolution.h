// SPDX-License-Identifier: Apache-2.0
// Mutation and crossover of voxel robots, for searches over bodies.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "mercury/random_voxel.h"
#include "mercury/voxel.h"

namespace mercury {

struct VoxelMutation {
  double flip = 0.02;                 // chance of each voxel to be drawn again
  double air = 0.3;                   // chance that such a voxel becomes air
  int swaps = 1;                      // pairs of patches that trade places
  int patch = 2;                      // largest size of such a patch [voxels]
  Mirror mirror = Mirror::none;       // the child's upper half along this axis is a copy of its lower half
  std::vector<MaterialId> materials;  // to draw from; empty = the parent's own, and one time in four any base material
};

// Throws ParameterError("flip", ...) and so on unless the chances lie between 0 and 1, swaps is at least 0, patch at
// least 1, and the materials are base materials.
void validate(const VoxelMutation& mutation);

// The axis along which the grid's halves mirror each other: y where several do, none where none does.
Mirror mirror_of(const VoxelGrid& grid);

// The parent with some voxels flipped, then some patches swapped. Depends on its arguments alone, bit for bit on every
// machine. Unless flip and swaps are both 0, the child's largest body is another one than its parent's: a draw that
// changes nothing there, or leaves only air, is repeated up to 30 times; then one voxel of the body gets another
// material. (A body that cannot change, such as a grid of one voxel with one material to draw from, is copied.) Throws
// InputError for a grid or a mutation that is not valid.
VoxelGrid mutate(const VoxelGrid& parent, const VoxelMutation& mutation, std::uint64_t seed);

// A child of a's size and edge, in blocks of `patch` voxels, each from a or b with probability 1/2. b is centered in a;
// where b has no voxel because it is smaller, the child takes a's. With a mirror the child's halves are alike. A child
// that would be all air is a copy of a. Throws InputError for a grid or a patch that is not valid.
VoxelGrid cross(const VoxelGrid& a, const VoxelGrid& b, std::uint64_t seed, int patch = 2,
                Mirror mirror = Mirror::none);

// The same for robots made from grids. The child keeps the (first) parent's materials and environment. Throw
// InputError if a parent is not a voxel robot.
Robot mutate_voxel_robot(const Robot& parent, const VoxelMutation& mutation, std::uint64_t seed,
                         const std::string& name);
Robot cross_voxel_robots(const Robot& a, const Robot& b, std::uint64_t seed, const std::string& name, int patch = 2,
                         Mirror mirror = Mirror::none);

}  // namespace mercury
