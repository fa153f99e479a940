// SPDX-License-Identifier: Apache-2.0
// The share of ambient light that arrives, from the half-size map of occlusion.comp. Needs frame.glsl.
layout(binding = 3) uniform sampler2D occlusion_map;  // share of ambient light, depth

// The mean of the four nearest texels, weighted toward those at this pixel's depth.
float openness(vec2 pixel, float range) {
  vec2 size = vec2(textureSize(occlusion_map, 0));
  vec2 at = 0.5 * pixel;
  vec2 f = fract(at - 0.5);
  vec2 middle = (floor(at - 0.5) + 1.0) / size;
  vec4 open = textureGather(occlusion_map, middle, 0);
  vec4 ranges = textureGather(occlusion_map, middle, 1);
  vec4 near = vec4((1.0 - f.x) * f.y, f.x * f.y, f.x * (1.0 - f.y), (1.0 - f.x) * (1.0 - f.y)) + 0.01;
  vec4 weights = near / (1e-3 + abs(ranges - range) * (40.0 / range));
  return dot(weights, open) / dot(weights, vec4(1.0));
}
