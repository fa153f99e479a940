// SPDX-License-Identifier: Apache-2.0
// voxel(): a robot from a grid.
#include "mercury/voxel.h"

#include <nanobind/stl/string.h>

#include <algorithm>

#include "mercury/error.h"
#include "python/src/bindings.h"
#include "python/src/robot_arrays.h"
#include "python/src/values.h"

namespace mercury::python {
namespace {

// The table of air, the base materials that are given, and the default ones for the rest.
std::vector<Material> table_of(nb::handle given) {
  const std::vector<Material> rows = materials_from(given);
  if (rows.size() < 2 || rows.size() > base_material_count + 1)
    throw InputError("materials: " + std::to_string(rows.size()) + " rows; give 2 to " +
                     std::to_string(base_material_count + 1) + ", of which the first is air");
  std::array<Material, base_material_count> bases;
  std::ranges::copy(default_materials().subspan(1, base_material_count), bases.begin());
  for (std::size_t i = 1; i < rows.size(); ++i) {
    validate(rows[i], "materials: row " + std::to_string(i));
    bases[i - 1] = rows[i];
  }
  return material_table(bases);
}

SharedRobot robot_of(nb::handle cells, nb::handle edge, nb::handle name, nb::handle materials) {
  VoxelGrid grid = grid_from(cells);
  grid.edge = static_cast<float>(number_from("edge", edge));
  VoxelRobotOptions options{.name = text_from("name", name)};
  if (!materials.is_none()) options.materials = table_of(materials);
  const ReleasedGil released;
  return {std::make_shared<const Robot>(make_voxel_robot(grid, options))};
}

}  // namespace

void bind_voxel(nb::module_& module) {
  module.def(
      "voxel", &robot_of, nb::arg("grid").none(), nb::kw_only(), nb::arg("edge").none() = 0.1,
      nb::arg("name").none() = "voxel", nb::arg("materials") = nb::none(),
      nb::sig("def voxel(grid: numpy.typing.ArrayLike, *, edge: float = 0.1, name: str = 'voxel', "
              "materials: numpy.typing.ArrayLike | None = None) -> Robot"),
      "The largest connected body of a grid of voxels as a robot.\n\n"
      "grid: (x, y, z), a base material (1 to 22) for each voxel, 0 = air. edge: of a voxel [m].\n"
      "materials: (2 to 23, 4 or 5) of air (row 0) and the base materials, as in Robot(); None or missing rows = the\n"
      "default ones. Springs at the border of two materials have their means. Raises InputError.");
}

}  // namespace mercury::python
