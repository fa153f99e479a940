// SPDX-License-Identifier: Apache-2.0
#include "app/export/exported_robot.h"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <unordered_map>
#include <utility>

#include "app/scene/appearance.h"
#include "mercury/error.h"
#include "mercury/inspect.h"
#include "mercury/observables.h"
#include "mercury/origin.h"

namespace mercury {

ExportedRobot exported_robot(const Robot& robot) {
  Environment environment;
  try {
    if (const std::string name = environment_of(robot); !name.empty()) environment = environment_named(name);
  } catch (const InputError&) {  // an origin may say anything
  }
  return {.robot = robot, .materials = materials_of(robot), .environment = environment};
}

Pose rest_pose(const Robot& robot) { return {.positions = robot.masses, .velocities = {}}; }

bool is_finite(std::span<const Vec3> positions) {
  return std::ranges::all_of(positions,
                             [](Vec3 p) { return std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.z); });
}

std::vector<render::Color> colors_of(const Robot& robot) {
  return material_colors(materials_of(robot), robot.materials.empty());
}

std::vector<ExportedMaterial> exported_materials(const Robot& robot) {
  const std::vector<render::Color> colors = colors_of(robot);
  std::vector<ExportedMaterial> materials;
  const std::vector<MaterialId> of_faces = face_materials(robot);
  if (std::ranges::find(of_faces, air) != of_faces.end())
    materials.push_back({.id = air, .name = "none", .color = colors[air]});
  for (MaterialUse& use : inspect(robot).materials)
    materials.push_back({.id = use.id, .name = std::move(use.name), .color = colors[use.id]});
  return materials;
}

SpringValues spring_values(const ExportedRobot& exported, const Pose& pose) {
  const std::vector<MaterialNow> materials = materials_at(exported.materials, exported.environment, pose.time);
  SpringValues values;
  values.strain.reserve(exported.robot.springs.size());
  values.force.reserve(exported.robot.springs.size());
  for (const Spring& spring : exported.robot.springs) {
    const MaterialNow& material = materials[spring.material];
    values.strain.push_back(strain(spring_length(spring, pose.positions), spring.rest_length));
    values.force.push_back(spring_force(material.stiffness, stretch(spring, material, pose.positions)));
  }
  return values;
}

std::vector<std::array<std::uint32_t, 3>> springs_of_faces(const Robot& robot) {
  const auto key = [](std::uint16_t a, std::uint16_t b) {
    return std::uint32_t{std::min(a, b)} << 16 | std::max(a, b);
  };
  std::unordered_map<std::uint32_t, std::uint32_t> springs;
  springs.reserve(robot.springs.size());
  for (std::uint32_t i = 0; i < robot.springs.size(); ++i)
    springs.try_emplace(key(robot.springs[i].a, robot.springs[i].b), i);
  const auto between = [&](std::uint16_t a, std::uint16_t b) {
    const auto found = springs.find(key(a, b));
    return found == springs.end() ? no_spring : found->second;
  };
  std::vector<std::array<std::uint32_t, 3>> found;
  found.reserve(robot.faces.size());
  for (const Face& face : robot.faces)
    found.push_back({between(face.a, face.b), between(face.b, face.c), between(face.c, face.a)});
  return found;
}

std::string identifier_of(const std::string& name) {
  std::string word;
  for (const char letter : name) word += std::isalnum(static_cast<unsigned char>(letter)) ? letter : '_';
  if (word.empty() || std::isdigit(static_cast<unsigned char>(word.front()))) word.insert(word.begin(), '_');
  return word;
}

}  // namespace mercury
