// SPDX-License-Identifier: Apache-2.0
// A tile with round corners and a frame, in flat colors. Its fill takes shadows.
#include "frame.glsl"
#include "shadow.glsl"
struct Tile {
  vec4 center, half_width, half_height;
  vec4 fill, frame;
};
layout(std430, binding = 11) readonly buffer Tiles { Tile tiles[]; };

layout(location = 0) in vec2 at;
layout(location = 1) in vec3 world;
layout(location = 2) flat in uint index;
layout(location = 0) out vec4 color;

// Without speckles: GPUs shade fragments in quads of two by two. Each of a quad has a pattern of samples of its own, and
// takes the mean of all four by its derivatives, so that it costs no more samples:
//   0 1
//   2 3
float smooth_visibility(vec3 point, vec3 normal) {
#if SHADOW_BLOCKERS > 0
  ivec2 odd = ivec2(gl_FragCoord.xy) & 1;
  float lit = key_visibility(point, normal, fract(frame.lens.z + (float(odd.x + 2 * odd.y) + 0.5) / 4.0));
  lit += (0.5 - float(odd.x)) * dFdxFine(lit);
  return lit + (0.5 - float(odd.y)) * dFdyFine(lit);
#else
  return key_visibility(point, normal, 0.0);  // its pattern is the same everywhere
#endif
}

void main() {
  Tile tile = tiles[index];
  vec2 half_size = vec2(length(tile.half_width.xyz), length(tile.half_height.xyz));
  float shorter = min(half_size.x, half_size.y), radius = 0.12 * shorter, thickness = 0.055 * shorter;
  vec2 off = abs(at) - half_size + radius;
  float outside = length(max(off, vec2(0.0))) + min(max(off.x, off.y), 0.0) - radius;
  float pixel = max(fwidth(at.x) + fwidth(at.y), 1e-6) * 0.5;
  float cover = clamp(0.5 - outside / pixel, 0.0, 1.0);
  float inside = clamp(0.5 - (outside + max(thickness, 1.5 * pixel)) / pixel, 0.0, 1.0);
  vec3 normal = normalize(cross(tile.half_width.xyz, tile.half_height.xyz));
  float lit = smooth_visibility(world, normal);
  color = vec4(mix(tile.frame.rgb, tile.fill.rgb * mix(0.55, 1.0, lit), inside), cover);
}
