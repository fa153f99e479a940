// SPDX-License-Identifier: Apache-2.0
#include "app/scene/face_forces.h"

#include <variant>

#include "sim/physics/environments.h"

namespace mercury {

bool has_face_forces(const Environment& environment) {
  return std::visit([](const auto& kind) { return decltype(model_of(kind))::has_faces; }, environment);
}

FaceForce face_force(const Environment& environment, const Face& face, std::span<const Vec3> positions,
                     std::span<const Vec3> velocities) {
  const Vec3 a = positions[face.a], b = positions[face.b], c = positions[face.c];
  const Vec3 area_normal = 0.5f * cross(b - a, c - a);
  const float third = 1.0f / 3;
  const Vec3 velocity = third * (velocities[face.a] + velocities[face.b] + velocities[face.c]);
  FaceForce result{.center = third * (a + b + c), .area = length(area_normal)};
  std::visit(
      [&](const auto& kind) {
        const auto model = model_of(kind);
        if constexpr (decltype(model)::has_faces) {
          const Vec3 force = model.on_face(area_normal, velocity);
          const Vec3 flow = kind.flow - velocity;
          const float squared = dot(flow, flow);
          result.drag = squared > 0 ? (dot(force, flow) / squared) * flow : Vec3{};
          result.lift = force - result.drag;
        }
      },
      environment);
  return result;
}

}  // namespace mercury
