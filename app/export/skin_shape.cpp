// SPDX-License-Identifier: Apache-2.0
#include "app/export/skin_shape.h"

#include "app/scene/appearance.h"
#include "mercury/generator.h"

namespace mercury {

SkinShape skin_shape(const Robot& robot, bool with_springs) {
  std::vector<bool> shown(robot.masses.size());
  for (const Face& face : robot.faces) shown[face.a] = shown[face.b] = shown[face.c] = true;
  if (with_springs)
    for (const Spring& spring : robot.springs) shown[spring.a] = shown[spring.b] = true;
  SkinShape shape;
  std::vector<std::uint16_t> vertex(robot.masses.size());
  for (std::size_t mass = 0; mass < shown.size(); ++mass) {
    if (!shown[mass]) continue;
    vertex[mass] = static_cast<std::uint16_t>(shape.masses.size());
    shape.masses.push_back(static_cast<std::uint16_t>(mass));
  }
  for (const Face& face : robot.faces) shape.faces.push_back({vertex[face.a], vertex[face.b], vertex[face.c]});
  shape.face_materials = face_materials(robot);
  std::array<bool, max_materials> used{};
  for (const MaterialId id : shape.face_materials) used[id] = true;
  if (with_springs)
    for (const Spring& spring : robot.springs) {
      shape.springs.push_back({vertex[spring.a], vertex[spring.b]});
      shape.spring_materials.push_back(spring.material);
      used[spring.material] = true;
    }
  shape.materials = exported_materials(robot);
  std::erase_if(shape.materials, [&](const ExportedMaterial& material) { return !used[material.id]; });
  const Generator* const generator = generator_of(robot);
  shape.is_smooth = generator && generator->smooth;
  return shape;
}

std::vector<Vec3> vertices_of(const SkinShape& shape, std::span<const Vec3> positions) {
  std::vector<Vec3> vertices;
  vertices.reserve(shape.masses.size());
  for (const std::uint16_t mass : shape.masses) vertices.push_back(positions[mass]);
  return vertices;
}

std::vector<Vec3> vertex_normals(const SkinShape& shape, std::span<const Vec3> vertices) {
  std::vector<Vec3> normals(vertices.size());
  for (const auto& [a, b, c] : shape.faces) {
    const Vec3 area = cross(vertices[b] - vertices[a], vertices[c] - vertices[a]);
    for (const std::uint16_t vertex : {a, b, c}) normals[vertex] += area;
  }
  for (Vec3& normal : normals) {
    const float size = length(normal);
    normal = size > 0 ? (1 / size) * normal : Vec3{0, 0, 1};
  }
  return normals;
}

std::vector<render::Color> vertex_colors(const SkinShape& shape) {
  std::array<std::array<float, 3>, max_materials> linear{};
  for (const ExportedMaterial& material : shape.materials) linear[material.id] = render::linear_of(material.color);
  std::vector<std::array<float, 3>> sums(shape.masses.size());
  std::vector<float> counts(shape.masses.size());
  for (std::size_t face = 0; face < shape.faces.size(); ++face)
    for (const std::uint16_t vertex : shape.faces[face]) {
      ++counts[vertex];
      for (std::size_t c = 0; c < 3; ++c) sums[vertex][c] += linear[shape.face_materials[face]][c];
    }
  std::vector<render::Color> colors(sums.size(), render::rgb(0x808080));
  for (std::size_t i = 0; i < sums.size(); ++i)
    if (counts[i] > 0)
      colors[i] = render::color_of_linear({sums[i][0] / counts[i], sums[i][1] / counts[i], sums[i][2] / counts[i]});
  return colors;
}

std::vector<std::vector<std::uint32_t>> by_material(const SkinShape& shape, std::span<const MaterialId> of_elements) {
  std::array<std::size_t, max_materials> place{};
  for (std::size_t i = 0; i < shape.materials.size(); ++i) place[shape.materials[i].id] = i;
  std::vector<std::vector<std::uint32_t>> found(shape.materials.size());
  for (std::uint32_t i = 0; i < of_elements.size(); ++i) found[place[of_elements[i]]].push_back(i);
  return found;
}

}  // namespace mercury
