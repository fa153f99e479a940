// SPDX-License-Identifier: Apache-2.0
// The camera in the user's hand: orbit, pan, zoom, frame, follow, and the moves that go by themselves.
#pragma once

#include <cstddef>
#include <optional>
#include <span>

#include "app/scene/camera_plan.h"
#include "render/camera.h"

namespace mercury::window {

// Modes are those of a video (app/scene/camera_plan.h); CameraMode::still is the free camera.
class OrbitController {
 public:
  // A mode given by the user or a settings file begins at the next at().
  void set_mode(CameraMode mode);
  CameraMode mode() const { return mode_; }
  // Goes along with one robot; nothing = with the middle of the group.
  void follow(std::optional<std::size_t> robot);
  std::optional<std::size_t> followed() const { return robot_; }

  // Drags, in shares of the picture's height. Turning by hand ends the modes that turn or look straight down.
  void turn(float right, float up);
  void pan(float right, float up);
  // Moves closer for a factor < 1.
  void zoom(float factor);
  // Looks at the robots of these boxes, all of them in the picture; glides there.
  void frame(std::span<const render::Bounds> robots, float aspect);
  // The same at once.
  void start(std::span<const render::Bounds> robots, float aspect);

  // The camera now; call once a picture with the time since the last one [s].
  render::Camera at(std::span<const render::Bounds> robots, float aspect, double dt);
  const render::Orbit& orbit() const { return orbit_; }
  void set_orbit(const render::Orbit& orbit);

  // For a video that is to look alike.
  CameraPlan plan() const;

  float turn_period = 20;      // of the turntable [s]
  float field_of_view = 0.6f;  // [rad]
  // Whether it still moves by itself.
  bool gliding() const { return glide_ > 0; }

 private:
  void glide_to(const render::Orbit& wanted, double dt, double lag);

  CameraMode mode_ = CameraMode::still;
  std::optional<std::size_t> robot_;
  render::Orbit orbit_;
  render::Orbit aim_;  // where a glide ends
  double glide_ = 0;   // time that is left of it [s]
};

}  // namespace mercury::window
