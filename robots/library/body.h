// SPDX-License-Identifier: Apache-2.0
// What the sample robots are shaped with: a grid, and up to 20 muscles of their own.
#pragma once

#include <string>
#include <vector>

#include "mercury/voxel.h"

namespace mercury::library {

// x points ahead, y to the left, z up.
class Body {
 public:
  // `environment` is where it lives, "ocean" or "land".
  Body(std::string name, std::string environment, int nx, int ny, int nz);

  int nx() const { return grid_.nx; }
  int ny() const { return grid_.ny; }
  int nz() const { return grid_.nz; }

  // A muscle of this kind; the same id for equal muscles. Phases are not taken modulo 2 pi: between two voxels the
  // springs have the mean phase, which is right only where neighbours count the same turns.
  // A negative amplitude makes the antagonist: where the two meet, springs keep their length.
  // Throws std::logic_error beyond 20.
  MaterialId muscle(const Material& kind);
  // As tissue and bone of the defaults, with another stiffness [N/m].
  void set_tissue_stiffness(float stiffness) { tissue_stiffness_ = stiffness; }
  void set_bone_stiffness(float stiffness) { bone_stiffness_ = stiffness; }

  // Sets every voxel to what `material_at(x, y, z)` gives.
  template <class MaterialAt>
  void fill(MaterialAt material_at) {
    for (int z = 0; z < grid_.nz; ++z)
      for (int y = 0; y < grid_.ny; ++y)
        for (int x = 0; x < grid_.nx; ++x) grid_.cell(x, y, z) = material_at(x, y, z);
  }

  Robot robot() const;

 private:
  std::string name_, environment_;
  VoxelGrid grid_;
  std::vector<Material> muscles_;
  float tissue_stiffness_ = 40, bone_stiffness_ = 100;
};

// Where x stands from 0 (first voxel's middle) to 1 (last voxel's middle) of n voxels.
inline float along(int x, int n) { return n > 1 ? static_cast<float>(x) / static_cast<float>(n - 1) : 0.5f; }
// Distance of a voxel's middle from the middle of n voxels [voxels].
inline float from_middle(int x, int n) { return static_cast<float>(x) - static_cast<float>(n - 1) / 2; }

}  // namespace mercury::library
