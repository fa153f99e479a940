// SPDX-License-Identifier: Apache-2.0
// A voxel body under design: a grid, and up to 20 muscles of its own.
#pragma once

#include <numbers>
#include <string>
#include <vector>

#include "mercury/voxel.h"

namespace mercury::library {

inline constexpr float turn = 2 * std::numbers::pi_v<float>;  // [rad]

// x points ahead, y to the left, z up.
class Body {
 public:
  // `environment` is where the robot belongs, "ocean" or "land".
  Body(std::string name, std::string environment, int nx, int ny, int nz);

  int nx() const { return grid_.nx; }
  int ny() const { return grid_.ny; }
  int nz() const { return grid_.nz; }

  // The id of a muscle; equal muscles get the same id. Do not reduce phases modulo 2 pi: springs between two voxels
  // have the mean of both phases, which is right only if neighbors count the same turns. A negative amplitude makes an
  // antagonist; where a muscle and its antagonist meet, springs keep their length. Throws std::logic_error beyond 20.
  MaterialId muscle(const Material& kind);
  // Changes the stiffness of tissue and bone [N/m].
  void set_tissue_stiffness(float stiffness) { tissue_stiffness_ = stiffness; }
  void set_bone_stiffness(float stiffness) { bone_stiffness_ = stiffness; }

  // Sets every voxel to material_at(x, y, z).
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

// The position of voxel x among n: 0 for the first, 1 for the last.
inline float along(int x, int n) { return n > 1 ? static_cast<float>(x) / static_cast<float>(n - 1) : 0.5f; }
// The distance of voxel x from the middle of n voxels, with its sign [voxels].
inline float from_middle(int x, int n) { return static_cast<float>(x) - static_cast<float>(n - 1) / 2; }

}  // namespace mercury::library
