// The uniform block that all shaders of one picture share; shaders/frame.glsl has the same members in the same order.
#pragma once

#include <Eigen/Core>

namespace mercury::render {

struct FrameBlock {
  Eigen::Matrix4f view_projection, inverse_view_projection, view;
  Eigen::Vector4f eye, to_key, key_light, sky_light, ground_light, backdrop_high, backdrop_low, cut, screen;
};

}  // namespace mercury::render
