// SPDX-License-Identifier: Apache-2.0
// How a voxel robot's grid is kept in its origin.
#pragma once

#include <string>

#include "mercury/voxel.h"

namespace mercury {

// {"kind":"voxel","size":[nx,ny,nz],"edge":0.1,"environment":"ocean","seed":1,"index":2,"cells":[...]}: cells as in
// VoxelGrid; environment, seed and index where they are known.
std::string voxel_origin(const VoxelGrid& grid, const VoxelRobotOptions& options);

}  // namespace mercury
