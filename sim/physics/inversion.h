// SPDX-License-Identifier: Apache-2.0
// Whether a cell of a body is inside out (mercury/folding.h), on the host and on a device with the same bits.
#pragma once

#include "mercury/host_device.h"
#include "sim/physics/double3.h"

namespace mercury {

// Six times the volume; positive = right-handed.
MERCURY_HOST_DEVICE double sixfold_volume(Double3 a, Double3 b, Double3 c, Double3 d) {
  return dot(b - a, cross(c - a, d - a));
}

// `corner(k)` = position of corner k.
template <class Corner>
MERCURY_HOST_DEVICE bool is_inverted_tetrahedron(const Corner& corner) {
  return sixfold_volume(corner(0), corner(1), corner(2), corner(3)) < 0;
}

// Bits 0, 1 and 2 of k say on which side corner k is along the three axes.
template <class Corner>
MERCURY_HOST_DEVICE bool is_inverted_voxel(const Corner& corner) {
  // Four times the vectors between the centers of opposite sides.
  Double3 along_x, along_y, along_z;
  for (int k = 0; k < 8; ++k) {
    const Double3 x = corner(k);
    along_x = (k & 1) != 0 ? along_x + x : along_x - x;
    along_y = (k & 2) != 0 ? along_y + x : along_y - x;
    along_z = (k & 4) != 0 ? along_z + x : along_z - x;
  }
  return dot(along_x, cross(along_y, along_z)) < 0;
}

}  // namespace mercury
