// SPDX-License-Identifier: Apache-2.0
// The uniform block that all shaders of one picture share; shaders/frame.glsl explains the members, in the same order.
#pragma once

#include "render/camera.h"
#include "render/scene.h"
#include "render/style.h"
#include "render/vector.h"

namespace mercury::render {

struct FrameBlock {
  Matrix4 view_projection, inverse_view_projection, view, shadow = Matrix4::identity();
  Vector4 eye, to_key, key_light, sky_light, ground_light, backdrop_high, backdrop_low, floor_color, line_color, fog,
      screen, depth, shadow_size{1, 1, 0, 0}, ground, water, octave;
};

// The size of a pattern that is fixed in the world and suits any viewing distance: a power of two, which fades into its
// double as the distance grows.
struct Octave {
  float size = 1, share_of_double = 0;
};
Octave octave_of(float distance);

// Everything except what FitPass fills in.
FrameBlock frame_block(const Scene& scene, const Camera& camera, const Style& style, int width, int height);

}  // namespace mercury::render
