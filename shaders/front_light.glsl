// SPDX-License-Identifier: Apache-2.0
// Reads the result of front_light.comp. Needs bodies.glsl.
layout(binding = 11) uniform usampler2D front_light_map;

// How different a surface of the map, by its distance and normal, is from one at that depth with that normal.
float unlikeness(uint where, float range, vec2 normal) {
  vec2 turned = abs(unpackSnorm4x8(where).zw - normal);
  return abs(unpackHalf2x16(where).x - range) * (40.0 / range) + 4.0 * (turned.x + turned.y);
}

// How much of the key light, and what share of the ambient light, reach a point at that depth with that normal, as an
// octahedral direction. At edges, the pixel's values may belong to another surface; then the most similar of the neighboring pixels get the most
// weight.
vec2 front_light(ivec2 pixel, float range, vec2 normal) {
  uvec2 found = texelFetch(front_light_map, pixel, 0).rg;
  float difference = unlikeness(found.y, range, normal);
  vec2 light = unpackHalf2x16(found.x);
  if (difference < 0.1) return light;
  float weights = 1.0 / (0.02 + difference * difference);
  vec2 sum = weights * light;
  ivec2 last = textureSize(front_light_map, 0) - 1, offset = ivec2(1, 0);
  for (int i = 0; i < 4; ++i) {
    found = texelFetch(front_light_map, clamp(pixel + offset, ivec2(0), last), 0).rg;
    difference = unlikeness(found.y, range, normal);
    float weight = 1.0 / (0.02 + difference * difference);
    sum += weight * unpackHalf2x16(found.x);
    weights += weight;
    offset = ivec2(-offset.y, offset.x);
  }
  return sum / weights;
}
