// SPDX-License-Identifier: Apache-2.0
#include "app/window/viewport/orbit_controller.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>

namespace mercury::window {
namespace {

constexpr double glide_time = 0.45;  // [s]
constexpr float turn_speed = 3.6f;   // angle of a drag over the picture's height [rad]
constexpr float margin = 1.1f;       // around framed robots

render::Bounds all_of(std::span<const render::Bounds> boxes) {
  render::Bounds all;
  for (const render::Bounds& box : boxes)
    if (!box.empty()) all.extend(box);
  return all;
}

}  // namespace

void OrbitController::set_mode(CameraMode mode) {
  if (mode == CameraMode::still && mode_ == CameraMode::top) orbit_.elevation = 1.2f;
  mode_ = mode;
  glide_ = 0;
}

void OrbitController::follow(std::optional<std::size_t> robot) {
  robot_ = robot;
  set_mode(CameraMode::follow);
}

void OrbitController::set_orbit(const render::Orbit& orbit) {
  orbit_ = orbit;
  glide_ = 0;
}

void OrbitController::turn(float right, float up) {
  if (mode_ == CameraMode::top || mode_ == CameraMode::turntable) set_mode(CameraMode::still);
  orbit_.turn(-turn_speed * right, -turn_speed * up);
  aim_.azimuth = orbit_.azimuth;
  aim_.elevation = orbit_.elevation;
}

void OrbitController::pan(float right, float up) {
  if (mode_ != CameraMode::still) set_mode(CameraMode::still);
  glide_ = 0;
  orbit_.pan(-right, -up);
}

void OrbitController::zoom(float factor) {
  if (mode_ == CameraMode::group || mode_ == CameraMode::turntable || mode_ == CameraMode::top)
    set_mode(CameraMode::still);
  glide_ = 0;
  orbit_.zoom(factor);
  orbit_.distance = std::clamp(orbit_.distance, 0.02f, 5000.0f);
}

void OrbitController::frame(std::span<const render::Bounds> robots, float aspect) {
  if (all_of(robots).empty()) return;
  aim_ = orbit_;
  aim_.frame(robots, aspect, margin);
  glide_ = glide_time;
  if (mode_ != CameraMode::still && mode_ != CameraMode::follow) set_mode(CameraMode::still), glide_ = glide_time;
}

void OrbitController::start(std::span<const render::Bounds> robots, float aspect) {
  field_of_view = orbit_.field_of_view;
  if (!all_of(robots).empty()) orbit_.frame(robots, aspect, margin);
  glide_ = 0;
}

void OrbitController::begin(const CameraPlan& plan, std::optional<std::size_t> robot) {
  turn_period = static_cast<float>(plan.period);
  if (plan.target) orbit_.target = *plan.target;
  if (plan.distance) orbit_.distance = *plan.distance;
  robot_ = robot;
  set_mode(plan.mode);
}

CameraPlan OrbitController::plan() const {
  CameraPlan plan{.mode = mode_, .field_of_view = field_of_view, .period = static_cast<double>(turn_period)};
  if (mode_ == CameraMode::follow && robot_) plan.robot = std::to_string(*robot_);
  if (mode_ == CameraMode::top) return plan;
  plan.azimuth = orbit_.azimuth;
  plan.elevation = orbit_.elevation;
  if (mode_ != CameraMode::still) return plan;
  plan.target = orbit_.target;
  plan.distance = orbit_.distance;
  return plan;
}

void OrbitController::glide_to(const render::Orbit& wanted, double dt, double lag) {
  const auto share = static_cast<float>(1 - std::exp(-dt / lag));
  orbit_.target += share * (wanted.target - orbit_.target);
  orbit_.distance += share * (wanted.distance - orbit_.distance);
}

render::Camera OrbitController::at(std::span<const render::Bounds> robots, float aspect, double dt) {
  constexpr double lag = 0.5;
  orbit_.field_of_view = field_of_view;
  render::Orbit wanted = orbit_;
  const render::Bounds all = all_of(robots);
  switch (mode_) {
    case CameraMode::still:
      break;
    case CameraMode::follow:
      if (robot_ && *robot_ < robots.size() && !robots[*robot_].empty())
        render::follow(orbit_, robots[*robot_].center(), dt, 0.3);
      else if (!robot_ && !all.empty())
        render::follow(orbit_, all.center(), dt, lag);
      break;
    case CameraMode::turntable:
      orbit_.azimuth += static_cast<float>(2 * std::numbers::pi * dt) / turn_period;
      [[fallthrough]];
    case CameraMode::group:
      if (all.empty()) break;
      wanted.frame(robots, aspect, margin);
      glide_to(wanted, dt, lag);
      break;
    case CameraMode::top:
      orbit_.azimuth = wanted.azimuth = -std::numbers::pi_v<float> / 2;
      orbit_.elevation = wanted.elevation = std::numbers::pi_v<float> / 2;
      if (all.empty()) break;
      wanted.frame(robots, aspect, margin);
      glide_to(wanted, dt, lag);
      break;
  }
  if (glide_ > 0) {
    glide_ -= dt;
    glide_to(aim_, glide_ > 0 ? dt : 1e9, glide_time / 5);
  }
  return orbit_.camera();
}

}  // namespace mercury::window
