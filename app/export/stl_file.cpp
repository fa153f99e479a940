// SPDX-License-Identifier: Apache-2.0
// STL, binary: triangles with their normals, without colors.
#include <array>
#include <cmath>

#include "app/base/version.h"
#include "app/export/writers.h"

namespace mercury {
namespace {

// Outward; 0 for a face without area.
Vec3 unit_normal(Vec3 a, Vec3 b, Vec3 c) {
  const std::array<double, 3> u{double{b.x} - a.x, double{b.y} - a.y, double{b.z} - a.z},
      v{double{c.x} - a.x, double{c.y} - a.y, double{c.z} - a.z};
  const std::array<double, 3> n{u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]};
  const double length = std::hypot(n[0], n[1], n[2]);
  if (!(length > 0)) return {};
  return {static_cast<float>(n[0] / length), static_cast<float>(n[1] / length), static_cast<float>(n[2] / length)};
}

}  // namespace

void write_stl(const ExportedRobot& robot, const Pose& pose, const std::filesystem::path& path, const ExportChoices&) {
  OutputStreams files;
  OutputStream& file = files.add(path);
  // Not "solid ...", which marks the format's text form.
  file.text(fmt::format("{:<80.80}", fmt::format("{}: meters, z up", program_version)));
  file.raw(static_cast<std::uint32_t>(robot.robot.faces.size()));
  for (const Face& face : robot.robot.faces) {
    const Vec3 a = pose.positions[face.a], b = pose.positions[face.b], c = pose.positions[face.c];
    for (const Vec3 v : {unit_normal(a, b, c), a, b, c}) file.raw(v);
    file.raw(std::uint16_t{0});
  }
  files.keep();
}

}  // namespace mercury
