// SPDX-License-Identifier: Apache-2.0
// The grid of a voxel robot as the JSON text of its origin.
#pragma once

#include <string>

#include "mercury/voxel.h"

namespace mercury {

// {"kind":"voxel","size":[nx,ny,nz],"edge":0.1,"environment":"ocean","seed":1,"index":2,"cells":[...]}. The cells are
// in the order of VoxelGrid; environment, seed and index appear only if they are known.
std::string voxel_origin(const VoxelGrid& grid, const VoxelRobotOptions& options);

}  // namespace mercury
