// SPDX-License-Identifier: Apache-2.0
// Point caches (.pc2), which move the vertices of a mesh. The mesh is written beside it, as an OBJ of the same vertices
// in the same order.
//
//   "POINTCACHE2\0"   int32 version 1   int32 points   float first frame   float frames per sample   int32 samples
//   samples * points * 3 floats
#include "app/export/writers.h"

namespace mercury {

namespace {

std::filesystem::path mesh_beside(const std::filesystem::path& pc2) {
  return std::filesystem::path(pc2).replace_extension(".obj");
}

void write_cache(const ExportedRobot& robot, RecordedMotion& motion, const std::filesystem::path& path,
                 const ExportChoices& choices) {
  const SkinShape shape = skin_shape(robot.robot, choices.springs);
  OutputStreams files;
  add_obj(files, robot, shape, motion.pose(0), mesh_beside(path));
  OutputStream& file = files.add(path);
  file.text(std::string_view("POINTCACHE2\0", 12));
  file.raw(std::int32_t{1});
  file.raw(static_cast<std::int32_t>(shape.masses.size()));
  file.raw(0.0f);
  file.raw(1.0f);
  file.raw(static_cast<std::int32_t>(motion.frames()));
  for (std::size_t frame = 0; frame < motion.frames(); ++frame) {
    file.raw(std::span<const Vec3>(vertices_of(shape, motion.pose(frame).positions)));
    choices.watch(frame + 1, motion.frames());
  }
  files.close();
  files.keep();
}

}  // namespace

std::vector<std::filesystem::path> beside_pc2(const std::filesystem::path& pc2) {
  std::vector<std::filesystem::path> files = beside_obj(mesh_beside(pc2));
  files.push_back(mesh_beside(pc2));
  return files;
}

void write_pc2(const ExportedRobot& robot, RecordedMotion& motion, const std::filesystem::path& path,
               const ExportChoices& choices) {
  write_together(path, beside_pc2,
                 [&](const std::filesystem::path& name) { write_cache(robot, motion, name, choices); });
}

}  // namespace mercury
