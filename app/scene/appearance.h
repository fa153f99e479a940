// SPDX-License-Identifier: Apache-2.0
// How a robot is drawn: its shape, and the colors of its materials.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "mercury/robot.h"
#include "render/scene.h"

namespace mercury {

// A robot's shape in the form that the renderer takes. `first_material` is added to every material id.
class BodyShape {
 public:
  BodyShape(const Robot& robot, std::uint32_t first_material);
  render::Body body() const;

 private:
  std::vector<float> rest_positions_;
  std::vector<std::uint32_t> faces_, springs_, face_materials_, spring_materials_;
};

// The material of each face: that of the spring along its longest edge with a spring. In a voxel robot this is the
// diagonal of the voxel's side, which belongs only to that voxel. Air if no edge has a spring. A passive material with
// the name of an actuator counts as its muscle.
std::vector<MaterialId> face_materials(const Robot& robot);

// The color of each material of a table, by id. `defaults`: it is the default table, where a pair of materials has a
// blend of their two colors.
std::vector<render::Color> material_colors(std::span<const Material> materials, bool defaults);

// Writes the activation of each material at a time: from -1, muscle longest, to +1, muscle shortest, relative to the
// table's largest amplitude; 0 for passive materials.
void set_activations(std::span<const Material> materials, double time, std::span<render::RenderMaterial> drawn);

}  // namespace mercury
