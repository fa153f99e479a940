// SPDX-License-Identifier: Apache-2.0
// Voxel robots: a grid of cubes, each of one material, turned into masses, springs and a skin (paper, III.A).
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "mercury/material.h"
#include "mercury/robot.h"

namespace mercury {

// A box of nx * ny * nz voxels. With masses of 1 kg, voxels of 0.1 m have about the density of water.
struct VoxelGrid {
  int nx = 0, ny = 0, nz = 0;
  float edge = 0.1f;              // of a voxel [m]
  std::vector<MaterialId> cells;  // nx * ny * nz, x fastest, then y; each is air or a base material (1..22)

  VoxelGrid() = default;
  // All voxels of one material. Throws InputError unless every size is at least 1 and the grid has at most max_cells.
  VoxelGrid(int size_x, int size_y, int size_z, MaterialId fill = air);

  static constexpr std::size_t max_cells = std::size_t{1} << 26;

  std::size_t index(int x, int y, int z) const {
    return static_cast<std::size_t>(x) +
           static_cast<std::size_t>(nx) *
               (static_cast<std::size_t>(y) + static_cast<std::size_t>(ny) * static_cast<std::size_t>(z));
  }
  bool contains(int x, int y, int z) const { return x >= 0 && y >= 0 && z >= 0 && x < nx && y < ny && z < nz; }
  MaterialId& cell(int x, int y, int z) { return cells[index(x, y, z)]; }
  // Air outside of the grid.
  MaterialId at(int x, int y, int z) const { return contains(x, y, z) ? cells[index(x, y, z)] : air; }

  friend bool operator==(const VoxelGrid&, const VoxelGrid&) = default;
};

// Throws InputError("voxel grid: ...") unless sizes are at least 1, there is one cell per voxel, every cell is air or a
// base material, the edge is at least min_rest_length, and the grid is at most 2e6 m long.
void validate(const VoxelGrid& grid);

// The grid with everything but its largest connected body turned to air. Of equally large bodies the one with the first
// voxel stays. Two voxels are connected if they share a side: a body that hung on an edge or a corner would swing on it
// as on a hinge. (Within one body, voxels that touch at an edge or a corner share its masses.)
VoxelGrid largest_body(const VoxelGrid& grid);

// What a voxel robot has beside its grid.
struct VoxelRobotOptions {
  std::string name = "voxel";
  std::string environment;                  // where it belongs ("ocean"), kept in its origin; empty = not recorded
  std::optional<std::uint64_t> seed;        // kept in its origin
  std::optional<std::uint64_t> index;       // which robot of that seed's population, kept in its origin
  std::vector<Material> materials;          // its own table, pairs by the ids of combine(); empty = the 254 defaults
  std::vector<std::string> material_names;  // of its own table; may be empty
};

// The largest connected body of the grid as a robot. The grid's middle is at the origin of coordinates.
// Masses: the corners of its voxels, shared by neighbors, x fastest.
// Springs: every pair of a voxel's 8 masses, once. The material combines the two most common materials among the voxels
// that share the pair, without air (ties go to the lower id).
// Faces: the skin, two triangles per voxel side, counter-clockwise from outside; a closed oriented surface.
// Origin: {"kind": "voxel", ...}, enough for voxel_grid_of.
// Throws InputError for a grid that breaks a rule, is all air, or needs more than max_masses masses.
Robot make_voxel_robot(const VoxelGrid& grid, const VoxelRobotOptions& options = {});

// The grid that a voxel robot was made from, read from its origin; none for robots of another kind.
// Throws InputError("/origin: ...") if the origin is of kind "voxel" but holds no valid grid.
std::optional<VoxelGrid> voxel_grid_of(const Robot& robot);

}  // namespace mercury
