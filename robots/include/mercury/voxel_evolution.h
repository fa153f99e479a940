// SPDX-License-Identifier: Apache-2.0
// Mutation and crossover of voxel robots: what a search over bodies is built from.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "mercury/random_voxel.h"
#include "mercury/voxel.h"

namespace mercury {

struct VoxelMutation {
  double flip = 0.02;                 // chance of each voxel to be drawn anew
  double air = 0.3;                   // chance that a voxel drawn anew is air
  int swaps = 1;                      // pairs of patches that change places
  int patch = 2;                      // largest size of such a patch [voxels]
  Mirror mirror = Mirror::none;       // keeps (and makes) the halves along this axis alike
  std::vector<MaterialId> materials;  // that a voxel may be drawn of; empty = the parent's own, any base one in 1 of 4
};

// Throws InputError("--flip: ...") and the like unless the chances lie between 0 and 1, swaps is at least 0, patch at
// least 1, and the materials are base materials.
void validate(const VoxelMutation& mutation);

// The parent with some voxels flipped, then some patches swapped. Depends on its arguments alone, bit for bit on every
// machine. If nothing but air is left, the child is its parent.
VoxelGrid mutate(const VoxelGrid& parent, const VoxelMutation& mutation, std::uint64_t seed);

// A child of a's size and edge. Its blocks of `patch` voxels come from a or b, each as likely; b lies centred in a,
// and where it has no voxel because it is smaller, a's is taken. With a mirror the child's halves are alike. If
// nothing but air came together, the child is a.
VoxelGrid cross(const VoxelGrid& a, const VoxelGrid& b, std::uint64_t seed, int patch = 2,
                Mirror mirror = Mirror::none);

// The same for robots that were made from grids. The (first) parent's own materials and environment are kept.
// Throw InputError if a parent is not a voxel robot.
Robot mutate_voxel_robot(const Robot& parent, const VoxelMutation& mutation, std::uint64_t seed,
                         const std::string& name);
Robot cross_voxel_robots(const Robot& a, const Robot& b, std::uint64_t seed, const std::string& name, int patch = 2,
                         Mirror mirror = Mirror::none);

}  // namespace mercury
