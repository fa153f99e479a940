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
  float lit = key_visibility(world, normal, pixel_noise(gl_FragCoord.xy));
  color = vec4(mix(tile.frame.rgb, tile.fill.rgb * mix(0.55, 1.0, lit), inside), cover);
}
