// SPDX-License-Identifier: Apache-2.0
#include "app/window/viewport/orbit_controller.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>

namespace mercury::window {
namespace {

constexpr double glide_time = 0.45;  // [s]
constexpr float turn_speed = 3.6f;   // angle of a drag over the view's height [rad]
constexpr float margin = 1.1f;       // around framed robots
constexpr float steepest = 1.3f;     // elevation to which the camera returns after it looked down [rad]

}  // namespace

void OrbitController::set_mode(CameraMode mode) {
  if (mode == CameraMode::top && !from_above_) {
    before_ = orbit_;
    if (before_.elevation > steepest) before_ = {.azimuth = -1.3f, .elevation = 0.5f};
  }
  if (mode != CameraMode::top && from_above_) {
    orbit_.azimuth = before_.azimuth;
    orbit_.elevation = before_.elevation;
  }
  from_above_ = mode == CameraMode::top;
  if (mode == CameraMode::top || mode == CameraMode::turntable) facing_.reset();
  mode_ = mode;
  glide_ = 0;
  close_.reset();
}

// Lets go of the camera where it is.
void OrbitController::release() {
  mode_ = CameraMode::still;
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
  close_.reset();
  if (mode_ == CameraMode::top || mode_ == CameraMode::turntable) release();
  orbit_.turn(-turn_speed * right, -turn_speed * up);
  aim_.azimuth = orbit_.azimuth;
  aim_.elevation = orbit_.elevation;
}

void OrbitController::pan(float right, float up) {
  release();
  orbit_.pan(-right, -up);
}

void OrbitController::zoom(float factor) {
  if (mode_ == CameraMode::group || mode_ == CameraMode::turntable || mode_ == CameraMode::top) release();
  glide_ = 0;
  orbit_.zoom(factor);
  orbit_.distance = std::clamp(orbit_.distance, 0.02f, 5000.0f);
}

void OrbitController::frame(std::span<const render::Bounds> robots, float aspect) {
  if (bounds_of(robots).empty()) return;
  aim_ = orbit_;
  aim_.frame(robots, aspect, margin, free);
  if (mode_ != CameraMode::still && mode_ != CameraMode::follow) release();
  glide_ = glide_time;
}

void OrbitController::start(std::span<const render::Bounds> robots, float aspect) {
  field_of_view = orbit_.field_of_view;
  if (!bounds_of(robots).empty()) orbit_.frame(robots, aspect, margin, free);
  glide_ = 0;
}

void OrbitController::begin(const CameraPlan& plan, std::optional<std::size_t> robot) {
  turn_period = static_cast<float>(plan.period);
  if (plan.target) orbit_.target = *plan.target;
  if (plan.distance) orbit_.distance = *plan.distance;
  robot_ = robot;
  set_mode(plan.mode);
  facing_.reset();
}

void OrbitController::begin_close(std::size_t robot) {
  close_ = robot;
  close_time_ = 1.2;
}

void OrbitController::look_from(float azimuth, float elevation) {
  if (mode_ == CameraMode::turntable || mode_ == CameraMode::top) set_mode(CameraMode::group);
  if (mode_ == CameraMode::group) facing_ = render::Orbit{.azimuth = azimuth, .elevation = elevation};
  aim_ = orbit_;
  aim_.azimuth = azimuth;
  aim_.elevation = elevation;
  glide_ = glide_time;
}

void OrbitController::go_to(const CameraPlan& plan, std::optional<std::size_t> robot) {
  robot_ = robot;
  set_mode(plan.mode);
  turn_period = static_cast<float>(plan.period);
  field_of_view = plan.field_of_view;
  aim_ = orbit_;
  aim_.azimuth = plan.azimuth.value_or(orbit_.azimuth);
  aim_.elevation = plan.elevation.value_or(orbit_.elevation);
  aim_.target = plan.target.value_or(orbit_.target);
  aim_.distance = plan.distance.value_or(orbit_.distance);
  if (plan.mode != CameraMode::top) glide_ = glide_time;
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

// Ever slower, but not slower than can be seen: otherwise the view would have to be drawn again for seconds.
void OrbitController::glide_to(const render::Orbit& wanted, double dt, double lag) {
  constexpr float slowest = 0.01f;  // [rad/s], and of the distance per second
  const float turn = std::remainder(wanted.azimuth - orbit_.azimuth, 2 * std::numbers::pi_v<float>);
  const float rest = std::max({std::abs(turn), std::abs(wanted.elevation - orbit_.elevation),
                               (wanted.target - orbit_.target).norm() / orbit_.distance,
                               std::abs(wanted.distance - orbit_.distance) / orbit_.distance});
  const auto lagging = static_cast<float>(1 - std::exp(-dt / lag));
  const float share = std::min(1.0f, std::max(lagging, slowest * static_cast<float>(dt) / std::max(rest, 1e-9f)));
  orbit_.azimuth += share * turn;
  orbit_.elevation += share * (wanted.elevation - orbit_.elevation);
  orbit_.target += share * (wanted.target - orbit_.target);
  orbit_.distance += share * (wanted.distance - orbit_.distance);
}

// Raises the target, then the angle.
void OrbitController::stay_above_floor() {
  if (!floor) return;
  constexpr float clearance = 0.02f;  // of the eye, per distance
  orbit_.target.z = std::max(orbit_.target.z, *floor);
  const float sine = clearance + (*floor - orbit_.target.z) / orbit_.distance;
  orbit_.elevation = std::max(orbit_.elevation, std::asin(std::max(sine, -1.0f)));
}

render::Camera OrbitController::at(std::span<const render::Bounds> robots, float aspect, double dt) {
  constexpr double lag = 0.5;
  orbit_.field_of_view = field_of_view;
  render::Orbit wanted = orbit_;
  const render::Bounds all = bounds_of(robots);
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
      if (close_ && *close_ < robots.size() && close_time_ > 0) {
        close_time_ -= dt;
        wanted.frame(robots.subspan(*close_, 1), aspect, margin);
        glide_to(wanted, 1e9, lag);
        break;
      }
      wanted.frame(robots, aspect, margin, free);
      glide_to(wanted, dt, lag);
      break;
    case CameraMode::top:
      orbit_.azimuth = wanted.azimuth = -std::numbers::pi_v<float> / 2;
      orbit_.elevation = wanted.elevation = std::numbers::pi_v<float> / 2;
      if (all.empty()) break;
      wanted.frame(robots, aspect, margin, free);
      glide_to(wanted, dt, lag);
      break;
  }
  if (glide_ > 0) {
    glide_ -= dt;
    // In modes that keep the group in view, the glide changes only the direction.
    if (mode_ != CameraMode::still && mode_ != CameraMode::follow) {
      aim_.target = orbit_.target;
      aim_.distance = orbit_.distance;
      if (mode_ == CameraMode::turntable) aim_.azimuth = orbit_.azimuth;
    }
    glide_to(aim_, glide_ > 0 ? dt : 1e9, glide_time / 5);
  }
  stay_above_floor();
  return orbit_.camera();
}

}  // namespace mercury::window
