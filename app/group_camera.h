// A camera that keeps a moving group in view, without jerks.
#pragma once

#include <Eigen/Core>

#include <optional>
#include <span>

#include "render/camera.h"

namespace mercury {

class GroupCamera {
 public:
  // Looks along `direction`, whose target and distance do not matter.
  GroupCamera(const render::Orbit& direction, float aspect, float margin = 1.12f);

  // Once a frame, with the boxes of the robots and the time since the last frame in seconds of the video. The first
  // call frames them at once: their boxes touch the borders of a picture `margin` times smaller. Later ones follow with
  // a lag, but never so late that one is cut off. Empty boxes are left out.
  render::Camera follow(std::span<const render::Bounds> robots, double dt);

 private:
  render::Orbit orbit_;
  float aspect_, margin_;
  std::optional<Eigen::Vector3f> eye_;  // in its own axes: x right, y up, z forward
};

}  // namespace mercury
