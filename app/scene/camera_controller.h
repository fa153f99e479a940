// SPDX-License-Identifier: Apache-2.0
// Moves the camera of a video, frame by frame, as a CameraPlan says.
#pragma once

#include <optional>
#include <span>
#include <string>

#include "app/scene/camera_plan.h"
#include "render/camera.h"

namespace mercury {

// The properties of the picture that matter to the camera.
struct PictureFrame {
  float aspect = 16.0f / 9;
  render::Insets free;     // edges that a legend or other text covers
  bool on_ground = false;  // robots stand on the ground; the camera is higher than for swimmers
};

// The direction at the start: the plan's angles, or defaults for its mode. Target and distance are not set.
render::Orbit direction_of(const CameraPlan& plan, bool on_ground);

class CameraController {
 public:
  // `names`: of the robots. Throws ParameterError("camera", ...) when the plan follows an unknown robot.
  CameraController(const CameraPlan& plan, const PictureFrame& picture, std::span<const std::string> names);

  // The camera of the next frame. Call it once per frame with the boxes of the robots and the time since the last frame
  // [s of video]. Ignores empty boxes. The first call has no lag.
  render::Camera at(std::span<const render::Bounds> robots, double dt);

 private:
  void keep_in_view(std::span<const render::Bounds> robots, double dt);
  void follow(std::span<const render::Bounds> robots, double dt);
  void circle(std::span<const render::Bounds> robots, double dt);

  CameraPlan plan_;
  PictureFrame picture_;
  std::optional<std::size_t> robot_;  // the robot to follow; none = the group
  render::Orbit orbit_;
  bool started_ = false;
};

}  // namespace mercury
