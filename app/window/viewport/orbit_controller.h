// SPDX-License-Identifier: Apache-2.0
// The camera of the window: the user orbits, pans and zooms it, and it moves by itself in some modes.
#pragma once

#include <cstddef>
#include <optional>
#include <span>

#include "app/scene/camera_plan.h"
#include "render/camera.h"

namespace mercury::window {

// The modes are those of videos (app/scene/camera_plan.h). CameraMode::still is the free camera, which only the user
// moves.
class OrbitController {
 public:
  // Takes effect in the next at().
  void set_mode(CameraMode mode);
  CameraMode mode() const { return mode_; }
  // Whether a grid should lie flat: since the camera looks down, until it is set to another mode.
  bool from_above() const { return from_above_; }
  // Follows a robot, by its index; without a value, the center of the group.
  void follow(std::optional<std::size_t> robot);
  std::optional<std::size_t> followed() const { return robot_; }

  // Mouse drags, as fractions of the view's height. Turning ends the modes turntable and top; panning ends all modes
  // but still.
  void turn(float right, float up);
  void pan(float right, float up);
  // Multiplies the distance to the target.
  void zoom(float factor);
  // Glides to a position that shows all of these boxes.
  void frame(std::span<const render::Bounds> robots, float aspect);
  // The same without a glide.
  void start(std::span<const render::Bounds> robots, float aspect);

  // After start(), in mode group: shows this robot alone for a moment, then glides to the group.
  void begin_close(std::size_t robot);

  // Glides to where the eye is in this direction from the target. A camera that moves by itself then keeps the group in
  // view, and a grid should face it (facing()).
  void look_from(float azimuth, float elevation);
  // Glides to where a plan says, `robot` being the one that it follows.
  void go_to(const CameraPlan& plan, std::optional<std::size_t> robot);
  // The direction that a grid should face; none = that of the scene.
  const std::optional<render::Orbit>& facing() const { return facing_; }

  // Begins as a plan says, `robot` being the one that it follows. Call start() before.
  void begin(const CameraPlan& plan, std::optional<std::size_t> robot);

  // Advances the camera by `dt` seconds and returns it. Call once per frame. `robots`: one box per robot, which may
  // be empty.
  render::Camera at(std::span<const render::Bounds> robots, float aspect, double dt);
  const render::Orbit& orbit() const { return orbit_; }
  void set_orbit(const render::Orbit& orbit);
  // Moves the camera with what it looks at, also during a glide.
  void shift(const render::Vector3& by) {
    orbit_.target += by;
    aim_.target += by;
  }

  // The plan for a video that starts with this camera.
  CameraPlan plan() const;

  float turn_period = 20;      // of mode turntable [s]
  float field_of_view = 0.6f;  // [rad]
  // Edges of the view that a legend or other text covers; framed robots stay clear of them.
  render::Insets free;
  // Height of the floor, above which the camera stays [m]; none = it goes everywhere.
  std::optional<float> floor;
  // True during a glide.
  bool gliding() const { return glide_ > 0; }

 private:
  void glide_to(const render::Orbit& wanted, double dt, double lag);
  void stay_above_floor();
  void release();

  CameraMode mode_ = CameraMode::still;
  std::optional<std::size_t> robot_;
  bool from_above_ = false;
  std::optional<render::Orbit> facing_;  // its angles
  render::Orbit orbit_;
  render::Orbit before_;              // its angles were those of the camera before it looked down
  render::Orbit aim_;                 // the end of the glide
  double glide_ = 0;                  // remaining time of the glide [s]
  std::optional<std::size_t> close_;  // the robot that is shown alone
  double close_time_ = 0;             // remaining [s]
};

}  // namespace mercury::window
