// SPDX-License-Identifier: Apache-2.0
// The shape that formats for pictures hold: the skin, and the springs if they are asked for. Masses that neither has,
// those inside a body, are left out.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "app/export/exported_robot.h"

namespace mercury {

struct SkinShape {
  std::vector<std::uint16_t> masses;                // of each vertex: index in Robot::masses, rising
  std::vector<std::array<std::uint16_t, 3>> faces;  // vertices, counter-clockwise seen from outside
  std::vector<MaterialId> face_materials;
  std::vector<std::array<std::uint16_t, 2>> springs;  // vertices; empty unless asked for
  std::vector<MaterialId> spring_materials;
  std::vector<ExportedMaterial> materials;  // of faces and springs, by id
  bool is_smooth = false;                   // the skin stands for a curved surface, as pictures draw it
};

SkinShape skin_shape(const Robot& robot, bool with_springs);

// The positions of the vertices at a moment [m].
std::vector<Vec3> vertices_of(const SkinShape& shape, std::span<const Vec3> positions);

// Normals of a curved skin, per vertex: the mean of its faces by their areas. Outward; up without a face.
std::vector<Vec3> vertex_normals(const SkinShape& shape, std::span<const Vec3> vertices);

// The color of each vertex: the mean of its faces in linear light, gray without a face.
std::vector<render::Color> vertex_colors(const SkinShape& shape);

// The indices of all elements by their material, in the order of SkinShape::materials.
std::vector<std::vector<std::uint32_t>> by_material(const SkinShape& shape, std::span<const MaterialId> of_elements);

}  // namespace mercury
