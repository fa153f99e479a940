// SPDX-License-Identifier: Apache-2.0
#include "app/export/stage.h"

#include <algorithm>
#include <cmath>

#include "app/scene/camera_controller.h"
#include "app/scene/group_look.h"
#include "render/style.h"

namespace mercury {
namespace {

constexpr float aspect = 16.0f / 9;

// On the ground, or as far below swimmers as they are large.
StageFloor floor_below(const render::Bounds& reach, const Environment& environment) {
  const render::Vector3 middle = reach.center();
  const float half = 3 * std::max(reach.radius(), 0.1f),
              height = has_ground(environment) ? 0 : reach.low.z - 2 * (reach.high.z - reach.low.z);
  const render::Vector3 color = render::style_of(surroundings_of(environment), render::Theme::light).floor_color;
  const auto corner = [&](float x, float y) { return Vec3{middle.x + x * half, middle.y + y * half, height}; };
  return {.corners = {corner(-1, -1), corner(1, -1), corner(1, 1), corner(-1, 1)},
          .color = {color.x, color.y, color.z}};
}

StageCamera camera_for(const render::Bounds& reach, bool on_ground) {
  render::Orbit orbit = direction_of({}, on_ground);
  orbit.frame(reach, aspect, 1.1f);
  const render::Camera camera = orbit.camera();
  const render::Vector3 back = (camera.eye - camera.target).normalized(), right = camera.up.cross(back).normalized();
  return {.axes = {right, back.cross(right), back},
          .eye = camera.eye,
          .field_of_view = camera.field_of_view,
          .aspect = aspect,
          .near = 0.01f * orbit.distance,
          .far = 100 * orbit.distance};
}

}  // namespace

std::array<float, 4> StageCamera::quaternion() const {
  const auto& [r, u, b] = axes;
  const float trace = r.x + u.y + b.z;
  std::array<float, 4> q{};
  if (trace > 0) {
    const float s = 2 * std::sqrt(trace + 1);
    q = {(u.z - b.y) / s, (b.x - r.z) / s, (r.y - u.x) / s, s / 4};
  } else if (r.x >= u.y && r.x >= b.z) {
    const float s = 2 * std::sqrt(1 + r.x - u.y - b.z);
    q = {s / 4, (u.x + r.y) / s, (b.x + r.z) / s, (u.z - b.y) / s};
  } else if (u.y >= b.z) {
    const float s = 2 * std::sqrt(1 + u.y - r.x - b.z);
    q = {(u.x + r.y) / s, s / 4, (b.y + u.z) / s, (b.x - r.z) / s};
  } else {
    const float s = 2 * std::sqrt(1 + b.z - r.x - u.y);
    q = {(b.x + r.z) / s, (b.y + u.z) / s, s / 4, (r.y - u.x) / s};
  }
  return q;
}

Stage stage_of(const render::Bounds& reach, const Environment& environment, const StageChoices& choices) {
  Stage stage;
  if (reach.empty()) return stage;
  if (choices.floor) stage.floor = floor_below(reach, environment);
  if (choices.camera) stage.camera = camera_for(reach, has_ground(environment));
  return stage;
}

}  // namespace mercury
