// SPDX-License-Identifier: Apache-2.0
// The robots that benchmarks of whole batches step: cubes without air, with a random material per voxel.
#pragma once

#include "mercury/random_voxel.h"

namespace mercury {

inline RandomVoxelOptions full_cube(int edge) {
  RandomVoxelOptions full;
  full.smallest = full.largest = {edge, edge, edge};
  full.air = 0;
  full.patch = 1;
  full.mirror = Mirror::none;
  return full;
}

}  // namespace mercury
