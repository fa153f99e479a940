// SPDX-License-Identifier: Apache-2.0
// What a robot looks like: the shape that stays, and the looks of its materials as the muscles work.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "mercury/robot.h"
#include "render/scene.h"

namespace mercury {

// A robot's unchanging parts as the renderer takes them. `first_material` is added to every material id.
class BodyShape {
 public:
  BodyShape(const Robot& robot, std::uint32_t first_material);
  render::Body body() const;

 private:
  std::vector<float> rest_positions_;
  std::vector<std::uint32_t> faces_, springs_, face_materials_, spring_materials_;
};

// The material that a face is drawn in, one a face: that of the spring along its longest edge that has one. In a voxel
// robot this is the diagonal of the voxel's side, which belongs to that voxel alone. Air if no edge is a spring.
std::vector<MaterialId> face_materials(const Robot& robot);

// The colour of each material of a table, by id. `names` may be empty; in the default table a pair's colour lies
// between those of its two materials.
std::vector<render::Color> material_colors(std::span<const Material> materials, bool defaults);

// How far each material's muscle is contracted at a time: -1 longest to +1 shortest, by the table's largest amplitude;
// 0 for passive ones. Writes one a material.
void set_activations(std::span<const Material> materials, double time, std::span<render::RenderMaterial> drawn);

}  // namespace mercury
