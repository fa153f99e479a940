// SPDX-License-Identifier: Apache-2.0
#include "robots/library/body.h"

#include <algorithm>
#include <array>
#include <stdexcept>
#include <utility>

namespace mercury::library {

Body::Body(std::string name, std::string environment, int nx, int ny, int nz)
    : name_(std::move(name)), environment_(std::move(environment)), grid_(nx, ny, nz) {}

MaterialId Body::muscle(const Material& kind) {
  const auto found = std::find(muscles_.begin(), muscles_.end(), kind);
  const auto index = static_cast<std::size_t>(found - muscles_.begin());
  if (found == muscles_.end()) {
    if (index == muscle_count) throw std::logic_error(name_ + " needs more than 20 muscles");
    muscles_.push_back(kind);
  }
  return static_cast<MaterialId>(index + 1);
}

Robot Body::robot() const {
  std::array<Material, base_material_count> bases{};
  std::copy(muscles_.begin(), muscles_.end(), bases.begin());
  bases[tissue - 1] = {tissue_stiffness_, 0, 0, 0};
  bases[bone - 1] = {bone_stiffness_, 0, 0, 0};
  std::vector<std::string> names;
  for (int id = 0; id < default_material_count; ++id)
    names.push_back(default_material_name(static_cast<MaterialId>(id)));
  return make_voxel_robot(grid_, {.name = name_,
                                  .environment = environment_,
                                  .materials = material_table(bases),
                                  .material_names = std::move(names)});
}

}  // namespace mercury::library
