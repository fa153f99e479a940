// SPDX-License-Identifier: Apache-2.0
// PLY, binary. Faces have their exact colors; vertices have the mean of their faces, for programs that read only
// those.

#include "app/base/version.h"
#include "app/export/writers.h"

namespace mercury {
namespace {

void write_color(OutputStream& file, render::Color color) {
  file.raw(color.r);
  file.raw(color.g);
  file.raw(color.b);
}

}  // namespace

void write_ply(const ExportedRobot& robot, const Pose& pose, const std::filesystem::path& path,
               const ExportChoices& choices) {
  const SkinShape shape = skin_shape(robot.robot, choices.springs);
  const std::vector<render::Color> of_vertices = vertex_colors(shape), of_materials = colors_of(robot.robot);
  constexpr const char* color = "property uchar red\nproperty uchar green\nproperty uchar blue\n";
  OutputStreams files;
  OutputStream& file = files.add(path);
  file.print("ply\nformat binary_little_endian 1.0\ncomment {}: meters, z up\nelement vertex {}\n", program_version,
             shape.masses.size());
  file.print("property float x\nproperty float y\nproperty float z\n{}", color);
  file.print("element face {}\nproperty list uchar int vertex_indices\n{}", shape.faces.size(), color);
  if (choices.springs)
    file.print("element edge {}\nproperty int vertex1\nproperty int vertex2\n{}", shape.springs.size(), color);
  file.text("end_header\n");
  const std::vector<Vec3> vertices = vertices_of(shape, pose.positions);
  for (std::size_t i = 0; i < vertices.size(); ++i) {
    file.raw(vertices[i]);
    write_color(file, of_vertices[i]);
  }
  for (std::size_t i = 0; i < shape.faces.size(); ++i) {
    file.raw(std::uint8_t{3});
    for (const std::uint16_t vertex : shape.faces[i]) file.raw(std::int32_t{vertex});
    write_color(file, of_materials[shape.face_materials[i]]);
  }
  for (std::size_t i = 0; i < shape.springs.size(); ++i) {
    for (const std::uint16_t vertex : shape.springs[i]) file.raw(std::int32_t{vertex});
    write_color(file, of_materials[shape.spring_materials[i]]);
  }
  files.keep();
}

}  // namespace mercury
