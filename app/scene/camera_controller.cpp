// SPDX-License-Identifier: Apache-2.0
#include "app/scene/camera_controller.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "mercury/error.h"
#include "mercury/number_text.h"
#include "render/vector.h"

namespace mercury {
namespace {

constexpr double lag = 0.8;     // time constant with which the camera follows [s]
constexpr float margin = 1.1f;  // of the distance, around what is in view
constexpr float follow_margin = 1.8f;

// The camera's axes in the world.
struct Axes {
  render::Vector3 right, up, forward;
};

Axes axes_of(const render::Orbit& orbit) {
  const render::Camera camera = orbit.camera();
  const render::Vector3 forward = (camera.target - camera.eye).normalized();
  const render::Vector3 right = forward.cross(camera.up).normalized();
  return {right, right.cross(forward), forward};
}

// The smallest distance at which all boxes are in view of an orbit with this target: |x| <= tan_x depth for each
// corner.
float least_distance(std::span<const render::Bounds> boxes, const render::Orbit& orbit, float aspect) {
  const Axes axes = axes_of(orbit);
  const float upward = std::tan(orbit.field_of_view / 2), across = upward * aspect;
  float least = 0;
  for (const render::Bounds& box : boxes) {
    if (box.empty()) continue;
    for (int i = 0; i < 8; ++i) {
      const render::Vector3 corner(i & 1 ? box.high.x : box.low.x, i & 2 ? box.high.y : box.low.y,
                                   i & 4 ? box.high.z : box.low.z);
      const render::Vector3 p = corner - orbit.target;
      const float wide = std::abs(p.dot(axes.right)) / across, high = std::abs(p.dot(axes.up)) / upward;
      least = std::max(least, std::max(wide, high) - p.dot(axes.forward));
    }
  }
  return least;
}

std::size_t robot_named(const std::string& name, std::span<const std::string> names) {
  const auto found = std::find(names.begin(), names.end(), name);
  if (found != names.end()) return static_cast<std::size_t>(found - names.begin());
  if (const auto number = parse_number<std::size_t>(name); number && *number < names.size()) return *number;
  throw ParameterError(
      "camera", fmt::format("no robot is named \"{}\"; give a name, or a number from 0 to {}", name, names.size() - 1));
}

}  // namespace

render::Orbit direction_of(const CameraPlan& plan, bool on_ground) {
  render::Orbit orbit{.azimuth = -1.3f, .elevation = on_ground ? 0.6f : 0.35f};
  if (plan.mode == CameraMode::top) {
    orbit.azimuth = -std::numbers::pi_v<float> / 2;
    orbit.elevation = std::numbers::pi_v<float> / 2;
  }
  orbit.azimuth = plan.azimuth.value_or(orbit.azimuth);
  orbit.elevation = plan.elevation.value_or(orbit.elevation);
  orbit.field_of_view = plan.field_of_view;
  return orbit;
}

CameraController::CameraController(const CameraPlan& plan, const PictureFrame& picture,
                                   std::span<const std::string> names)
    : plan_(plan), picture_(picture), orbit_(direction_of(plan, picture.on_ground)) {
  if (!plan.robot.empty()) robot_ = robot_named(plan.robot, names);
}

render::Camera CameraController::at(std::span<const render::Bounds> robots, double dt) {
  switch (plan_.mode) {
    case CameraMode::group:
    case CameraMode::top:
      keep_in_view(robots, dt);
      break;
    case CameraMode::follow:
      follow(robots, dt);
      break;
    case CameraMode::turntable:
      circle(robots, dt);
      break;
    case CameraMode::still:
      if (started_) break;
      orbit_.frame(robots, picture_.aspect, margin / plan_.zoom, picture_.free);
      orbit_.target = plan_.target.value_or(orbit_.target);
      orbit_.distance = plan_.distance.value_or(orbit_.distance);
      break;
  }
  started_ = true;
  return orbit_.camera();
}

void CameraController::keep_in_view(std::span<const render::Bounds> robots, double dt) {
  constexpr float least_margin = 1.02f;  // that the lag may not go below
  render::Orbit wanted = orbit_;
  wanted.frame(robots, picture_.aspect, margin / plan_.zoom, picture_.free);
  const auto share = static_cast<float>(started_ ? 1 - std::exp(-dt / lag) : 1);
  orbit_.target += share * (wanted.target - orbit_.target);
  orbit_.distance += share * (wanted.distance - orbit_.distance);
  if (plan_.zoom <= 1)
    orbit_.distance = std::max(orbit_.distance, least_margin * least_distance(robots, orbit_, picture_.aspect));
}

void CameraController::follow(std::span<const render::Bounds> robots, double dt) {
  const auto followed = robot_ ? robots.subspan(*robot_, 1) : robots;
  const render::Bounds box = bounds_of(followed);
  if (box.empty()) return;  // it has exploded: the camera stays where it is
  if (!started_) orbit_.frame(followed, picture_.aspect, (robot_ ? follow_margin : margin) / plan_.zoom, picture_.free);
  render::Vector3 middle = render::Vector3::all(0);
  int count = 0;
  for (const render::Bounds& robot : followed) {
    if (robot.empty()) continue;
    middle += robot.center();
    ++count;
  }
  render::follow(orbit_, middle / static_cast<float>(count), started_ ? dt : INFINITY, lag);
}

void CameraController::circle(std::span<const render::Bounds> robots, double dt) {
  const render::Bounds box = bounds_of(robots);
  if (box.empty()) return;
  // Frames a sphere, which is the same from all sides, so that the distance does not vary as the camera turns.
  const float smaller_side = std::min(1.0f, picture_.aspect);
  const float half_angle = std::atan(smaller_side * std::tan(plan_.field_of_view / 2));
  const float distance = margin / plan_.zoom * box.radius() / std::sin(half_angle);
  const double since = started_ ? dt : INFINITY;
  render::follow(orbit_, box.center(), since, lag);
  orbit_.distance += static_cast<float>(1 - std::exp(-since / lag)) * (distance - orbit_.distance);
  if (started_) orbit_.azimuth += static_cast<float>(2 * std::numbers::pi * dt / plan_.period);
}

}  // namespace mercury
