// SPDX-License-Identifier: Apache-2.0
// Changes the voxels of a robot that has a grid in its origin.
#pragma once

#include <array>
#include <optional>
#include <string>

#include "mercury/random_voxel.h"
#include "mercury/robot.h"

namespace mercury {

using Cell = std::array<int, 3>;

// The voxel behind a face of the skin, and the air before it, which may lie one step outside of the grid.
struct VoxelSide {
  Cell voxel{}, beside{};
};
// None if the robot has no grid, or the face is not the side of one of its voxels.
std::optional<VoxelSide> voxel_side_of(const Robot& robot, std::size_t face);

enum class VoxelTool { add, remove, paint };

struct VoxelEdit {
  VoxelTool tool = VoxelTool::paint;
  MaterialId material = 1;       // of what is added or painted: 1 .. 22
  Mirror mirror = Mirror::none;  // does the same on the other side of the grid's middle
};

// The robot with one voxel more, fewer, or of another material. A voxel beside the grid makes the grid larger on both
// sides, so that its middle, and with it every mass, stays where it is. Name, environment, table of materials and
// actuators stay; seed and ancestry go, since the robot is no longer made that way. Voxels that lose their
// connection to the largest body go too. Throws InputError if the robot has no grid, would have no voxel left or too
// many masses, or for a material that is no base material.
Robot with_voxel(const Robot& robot, const VoxelSide& side, const VoxelEdit& edit);

}  // namespace mercury
