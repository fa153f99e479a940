// SPDX-License-Identifier: Apache-2.0
#include "app/scene/group_look.h"

#include "app/scene/appearance.h"

namespace mercury {

render::Surroundings surroundings_of(const Environment& environment) {
  return has_ground(environment) && !has_water(environment) ? render::Surroundings::land : render::Surroundings::water;
}

std::vector<std::pair<render::Color, std::string>> swatches_of(const std::array<bool, max_materials>& springs_of) {
  std::vector<bool> used(base_material_count + 1, false);
  for (int id = 1; id < default_material_count; ++id) {
    if (!springs_of[static_cast<std::size_t>(id)]) continue;
    const BasePair pair = base_materials_of(static_cast<MaterialId>(id));
    used[pair.first] = used[pair.second] = true;
  }
  const std::vector<render::Color> colors = material_colors(default_materials(), true);
  std::vector<std::pair<render::Color, std::string>> swatches;
  for (std::size_t id = 1; id < used.size(); ++id)
    if (used[id]) swatches.emplace_back(colors[id], default_material_name(static_cast<MaterialId>(id)));
  return swatches;
}

}  // namespace mercury
