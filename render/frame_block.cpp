// SPDX-License-Identifier: Apache-2.0
#include "render/frame_block.h"
#include "render/vector.h"

#include <algorithm>
#include <cmath>

namespace mercury::render {
Octave octave_of(float distance) {
  const float power = std::log2(std::max(distance, 1e-6f));
  const float whole = std::floor(power);
  const float t = std::clamp((power - whole - 0.35f) / 0.3f, 0.0f, 1.0f);
  // A share of 1 is the next power of two without a double.
  return t < 1 ? Octave{std::exp2(whole), t * t * (3 - 2 * t)} : Octave{std::exp2(whole + 1), 0};
}

FrameBlock frame_block(const Scene& scene, const Camera& camera, const Style& style, int width, int height) {
  FrameBlock b;
  const float aspect = float(width) / float(height);
  b.view = camera.view();
  b.view_projection = camera.projection(aspect) * b.view;
  b.inverse_view_projection = inverse(b.view_projection);
  const float distance = (camera.eye - camera.target).norm();
  b.eye = Vector4(camera.eye, float(std::fmod(scene.time, 3600.0)));
  b.to_key = Vector4(style.to_key.normalized(), style.key_size);
  b.key_light = Vector4(style.key_light, style.glow);
  b.sky_light = Vector4(style.sky_light, 0);
  b.ground_light = Vector4(style.ground_light, 0);
  b.backdrop_high = Vector4(style.backdrop_high, 0);
  b.backdrop_low = Vector4(style.backdrop_low, 0);
  b.floor_color = Vector4(style.floor_color, 0);
  b.line_color = Vector4(style.line_color, scene.patches.empty() ? 1 : 0);
  b.fog = Vector4(style.fog / distance, 0.55f * distance);
  b.screen = {float(width), float(height), 1 / float(width), 1 / float(height)};
  const float scale = 1 / std::tan(0.5f * camera.field_of_view);
  // Depth d in the buffer is the distance near far / (near + d (far - near)).
  b.depth = {camera.near, camera.far, aspect / scale, 1 / scale};
  b.ground = {0, 0, 1, scene.floor};
  b.water = {float(scene.surroundings), style.caustics, 0, distance};
  const Octave octave = octave_of(distance);
  b.octave = {octave.size, 2 * octave.size, octave.share_of_double, 0};
  return b;
}

}  // namespace mercury::render
