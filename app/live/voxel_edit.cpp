// SPDX-License-Identifier: Apache-2.0
#include "app/live/voxel_edit.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "mercury/error.h"
#include "mercury/origin.h"
#include "mercury/real_body.h"
#include "robots/carried_points.h"

namespace mercury {
namespace {

constexpr int most_voxels = 200;  // along one axis

Cell sizes_of(const VoxelGrid& grid) { return {grid.nx, grid.ny, grid.nz}; }

std::size_t axis_of(Mirror mirror) { return static_cast<std::size_t>(mirror) - 1; }

// The grid with one layer more on both sides of an axis.
VoxelGrid grown(const VoxelGrid& grid, std::size_t axis) {
  Cell sizes = sizes_of(grid), shift{};
  sizes[axis] += 2;
  shift[axis] = 1;
  VoxelGrid larger(sizes[0], sizes[1], sizes[2]);
  larger.edge = grid.edge;
  for (int z = 0; z < grid.nz; ++z)
    for (int y = 0; y < grid.ny; ++y)
      for (int x = 0; x < grid.nx; ++x) larger.cell(x + shift[0], y + shift[1], z + shift[2]) = grid.at(x, y, z);
  return larger;
}

// The grid without empty layers that lie on both sides of an axis.
VoxelGrid trimmed(VoxelGrid grid) {
  const auto solid = [&](std::size_t axis, int layer) {
    Cell at{};
    for (at[0] = 0; at[0] < grid.nx; ++at[0])
      for (at[1] = 0; at[1] < grid.ny; ++at[1])
        for (at[2] = 0; at[2] < grid.nz; ++at[2])
          if (at[axis] == layer && grid.at(at[0], at[1], at[2]) != air) return true;
    return false;
  };
  for (std::size_t axis = 0; axis < 3; ++axis)
    while (sizes_of(grid)[axis] > 2 && !solid(axis, 0) && !solid(axis, sizes_of(grid)[axis] - 1)) {
      Cell sizes = sizes_of(grid), shift{};
      sizes[axis] -= 2;
      shift[axis] = 1;
      VoxelGrid smaller(sizes[0], sizes[1], sizes[2]);
      smaller.edge = grid.edge;
      for (int z = 0; z < sizes[2]; ++z)
        for (int y = 0; y < sizes[1]; ++y)
          for (int x = 0; x < sizes[0]; ++x) smaller.cell(x, y, z) = grid.at(x + shift[0], y + shift[1], z + shift[2]);
      grid = std::move(smaller);
    }
  return grid;
}

VoxelGrid grid_of(const Robot& robot) {
  std::optional<VoxelGrid> grid = voxel_grid_of(robot);
  if (!grid) throw InputError(robot.name, "has no grid of voxels; only voxel robots can be edited");
  return *std::move(grid);
}

}  // namespace

// At rest, a face lies on the side of one voxel: half an edge behind it is that voxel's layer.
std::optional<VoxelSide> voxel_side_of(const Robot& robot, std::size_t face) {
  const std::optional<VoxelGrid> grid = voxel_grid_of(robot);
  if (!grid || face >= robot.faces.size()) return std::nullopt;
  const Face& corners = robot.faces[face];
  const Vec3 a = robot.masses[corners.a], b = robot.masses[corners.b], c = robot.masses[corners.c];
  const Vec3 normal = cross(b - a, c - a), middle = (1.0f / 3) * (a + b + c);
  const float size = length(normal);
  if (!(size > 0)) return std::nullopt;
  const auto cell_at = [&](Vec3 point) {
    const auto index = [&](float coordinate, int count) {
      return static_cast<int>(std::floor(coordinate / grid->edge + 0.5f * static_cast<float>(count)));
    };
    return Cell{index(point.x, grid->nx), index(point.y, grid->ny), index(point.z, grid->nz)};
  };
  const Vec3 half = (0.5f * grid->edge / size) * normal;
  const VoxelSide side{cell_at(middle - half), cell_at(middle + half)};
  const bool on_side = grid->at(side.voxel[0], side.voxel[1], side.voxel[2]) != air &&
                       grid->at(side.beside[0], side.beside[1], side.beside[2]) == air;
  return on_side ? std::optional(side) : std::nullopt;
}

Robot with_voxel(const Robot& robot, const VoxelSide& side, const VoxelEdit& edit) {
  if (edit.tool != VoxelTool::remove && (edit.material < 1 || edit.material > 22))
    throw InputError("material", fmt::format("{} is no base material; give 1 to 22", edit.material));
  VoxelGrid grid = grid_of(robot);
  Cell cell = edit.tool == VoxelTool::add ? side.beside : side.voxel;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const int size = sizes_of(grid)[axis];
    if (cell[axis] < -1 || cell[axis] > size) throw InputError(robot.name, "the place is not beside its body");
    if (cell[axis] >= 0 && cell[axis] < size) continue;
    if (size + 2 > most_voxels) throw InputError(robot.name, fmt::format("is {} voxels long already", size));
    grid = grown(grid, axis);
    ++cell[axis];
  }
  const MaterialId material = edit.tool == VoxelTool::remove ? air : edit.material;
  grid.cell(cell[0], cell[1], cell[2]) = material;
  if (edit.mirror != Mirror::none) {
    const std::size_t axis = axis_of(edit.mirror);
    cell[axis] = sizes_of(grid)[axis] - 1 - cell[axis];
    MaterialId& other = grid.cell(cell[0], cell[1], cell[2]);
    if (edit.tool != VoxelTool::paint || other != air) other = material;
  }
  if (std::ranges::all_of(grid.cells, [](MaterialId id) { return id == air; }))
    throw InputError(robot.name, "would have no voxel left");
  const Robot paper = without_real_body(robot);
  Robot changed = make_voxel_robot(trimmed(std::move(grid)), {.name = robot.name,
                                                              .environment = environment_of(robot),
                                                              .materials = paper.materials,
                                                              .material_names = paper.material_names});
  if (const std::optional<RealMaterial> real = real_material_of(robot))
    changed = with_real_body(changed, *real);
  else
    changed.actuators = robot.actuators;
  carry_points(robot, changed);
  carry_brain(robot, changed);
  return changed;
}

}  // namespace mercury
