// SPDX-License-Identifier: Apache-2.0
// Carries a camera plan out, frame by frame.
#pragma once

#include <Eigen/Core>

#include <optional>
#include <span>
#include <string>

#include "app/scene/camera_plan.h"
#include "render/camera.h"

namespace mercury {

// The picture that the camera makes.
struct PictureFrame {
  float aspect = 16.0f / 9;
  render::Insets free;     // parts of it that are covered by a legend and the like
  bool on_ground = false;  // robots stand on the ground, seen from higher up than swimming ones
};

// The direction a plan begins with: its angles, or those that suit the mode; target and distance are not set.
render::Orbit direction_of(const CameraPlan& plan, bool on_ground);

class CameraController {
 public:
  // `names`: of the robots. Throws InputError("--camera: ...") when the plan follows one that is not there.
  CameraController(const CameraPlan& plan, const PictureFrame& picture, std::span<const std::string> names);

  // Once a frame, with the boxes of the robots and the time since the last frame [s of video]. Boxes that are empty are
  // left out. The first call begins without a lag.
  render::Camera at(std::span<const render::Bounds> robots, double dt);

 private:
  void keep_in_view(std::span<const render::Bounds> robots, double dt);
  void go_along(std::span<const render::Bounds> robots, double dt);
  void circle(std::span<const render::Bounds> robots, double dt);

  CameraPlan plan_;
  PictureFrame picture_;
  std::optional<std::size_t> robot_;  // that is followed
  render::Orbit orbit_;
  bool started_ = false;
};

}  // namespace mercury
