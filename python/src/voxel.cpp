// SPDX-License-Identifier: Apache-2.0
// voxel(): a robot from a grid.
#include "mercury/voxel.h"

#include <nanobind/ndarray.h>
#include <nanobind/stl/optional.h>
#include <nanobind/stl/string.h>

#include <algorithm>
#include <optional>

#include "mercury/error.h"
#include "python/src/bindings.h"
#include "python/src/gil.h"

namespace mercury::python {
namespace {

using GridOfCells = nb::ndarray<const std::uint8_t, nb::ndim<3>, nb::device::cpu>;
using BaseMaterials = nb::ndarray<const float, nb::shape<-1, 4>, nb::device::cpu>;

// The table of air, the base materials that are given, and the default ones for the rest.
std::vector<Material> table_of(const BaseMaterials& given) {
  const std::size_t count = given.shape(0);
  if (count < 2 || count > base_material_count + 1)
    throw InputError("materials: " + std::to_string(count) + " rows; give 2 to " +
                     std::to_string(base_material_count + 1) + ", of which the first is air");
  std::array<Material, base_material_count> bases;
  std::ranges::copy(default_materials().subspan(1, base_material_count), bases.begin());
  for (std::size_t i = 1; i < count; ++i) {
    bases[i - 1] = {.stiffness = given(i, 0), .amplitude = given(i, 1), .frequency = given(i, 2), .phase = given(i, 3)};
    validate(bases[i - 1], "materials: row " + std::to_string(i));
  }
  return material_table(bases);
}

SharedRobot robot_of(const GridOfCells& cells, float edge, std::string name,
                     const std::optional<BaseMaterials>& materials) {
  for (std::size_t axis = 0; axis < 3; ++axis)
    if (cells.shape(axis) > VoxelGrid::max_cells) throw InputError("voxel grid: it is too large");
  const auto size = [&](std::size_t axis) { return static_cast<int>(cells.shape(axis)); };
  VoxelGrid grid(size(0), size(1), size(2));
  grid.edge = edge;
  for (int z = 0; z < grid.nz; ++z)
    for (int y = 0; y < grid.ny; ++y)
      for (int x = 0; x < grid.nx; ++x) grid.cell(x, y, z) = cells(x, y, z);
  VoxelRobotOptions options{.name = std::move(name)};
  if (materials) options.materials = table_of(*materials);
  const ReleasedGil released;
  return {std::make_shared<const Robot>(make_voxel_robot(grid, options))};
}

}  // namespace

void bind_voxel(nb::module_& module) {
  module.def(
      "voxel", &robot_of, nb::arg("grid"), nb::kw_only(), nb::arg("edge") = 0.1f, nb::arg("name") = "voxel",
      nb::arg("materials") = nb::none(),
      "The largest connected body of a grid of voxels as a robot.\n\n"
      "grid: (x, y, z) uint8, a base material (1 to 22) for each voxel, 0 = air. edge: of a voxel [m].\n"
      "materials: (2 to 23, 4) float32, stiffness [N/m], amplitude [1], frequency [rad/s] and phase [rad] of air (row "
      "0)\nand the base materials; None or missing rows = the default ones. Springs at the border of two materials "
      "have\ntheir means. Raises InputError.");
}

}  // namespace mercury::python
