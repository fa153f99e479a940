// SPDX-License-Identifier: Apache-2.0
// Wavefront OBJ with its materials (.mtl) beside it.
#include <fmt/format.h>

#include <cctype>
#include <set>

#include "app/base/version.h"
#include "app/export/writers.h"

namespace mercury {
namespace {

// Each name once, without blanks: some programs end a name there.
std::vector<std::string> names_of(const std::vector<ExportedMaterial>& materials) {
  std::vector<std::string> names;
  std::set<std::string> taken;
  for (const ExportedMaterial& material : materials) {
    std::string name;
    for (const char letter : material.name)
      name += std::isalnum(static_cast<unsigned char>(letter)) || letter == '+' || letter == '-' ? letter : '_';
    if (name.empty() || !taken.insert(name).second) name += fmt::format("-{}", material.id);
    taken.insert(name);
    names.push_back(name);
  }
  return names;
}

// Kd is linear light, as Blender reads it.
void write_materials(OutputStream& file, const SkinShape& shape, const std::vector<std::string>& names) {
  for (std::size_t i = 0; i < shape.materials.size(); ++i) {
    const auto [r, g, b] = render::linear_of(shape.materials[i].color);
    file.print("newmtl {}\nKd {} {} {}\nKs 0 0 0\nd 1\nillum 1\n\n", names[i], r, g, b);
  }
}

std::filesystem::path materials_beside(const std::filesystem::path& obj) {
  return std::filesystem::path(obj).replace_extension(".mtl");
}

}  // namespace

std::vector<std::filesystem::path> beside_obj(const std::filesystem::path& obj) { return {materials_beside(obj)}; }

void add_obj(OutputStreams& files, const ExportedRobot& exported, const SkinShape& shape, const Pose& pose,
             const std::filesystem::path& path) {
  const std::filesystem::path materials = materials_beside(path);
  const std::vector<std::string> names = names_of(shape.materials);
  write_materials(files.add(materials), shape, names);
  OutputStream& file = files.add(path);
  file.print("# {}: meters, z up\nmtllib {}\no {}\n", program_version, materials.filename().string(),
             identifier_of(exported.robot.name));
  for (const Vec3 v : vertices_of(shape, pose.positions)) file.print("v {} {} {}\n", v.x, v.y, v.z);
  const auto faces = by_material(shape, shape.face_materials), springs = by_material(shape, shape.spring_materials);
  for (std::size_t i = 0; i < shape.materials.size(); ++i) {
    file.print("usemtl {}\n", names[i]);
    for (const std::uint32_t face : faces[i]) {
      const auto [a, b, c] = shape.faces[face];
      file.print("f {} {} {}\n", a + 1, b + 1, c + 1);
    }
    for (const std::uint32_t spring : springs[i])
      file.print("l {} {}\n", shape.springs[spring][0] + 1, shape.springs[spring][1] + 1);
  }
}

void write_obj(const ExportedRobot& robot, const Pose& pose, const std::filesystem::path& path,
               const ExportChoices& choices) {
  write_together(path, beside_obj, [&](const std::filesystem::path& name) {
    OutputStreams files;
    add_obj(files, robot, skin_shape(robot.robot, choices.springs), pose, name);
    files.close();
    files.keep();
  });
}

}  // namespace mercury
