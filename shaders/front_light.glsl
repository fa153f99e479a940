// SPDX-License-Identifier: Apache-2.0
// Reads the result of front_light.comp. Needs bodies.glsl.
layout(binding = 11) uniform usampler2D front_light_map;

// How different a surface of the map, by its distance and normal, is from one at that depth with that normal.
float unlikeness(uint where, float range, vec2 normal) {
  vec2 turned = abs(unpackSnorm4x8(where).zw - normal);
  return abs(unpackHalf2x16(where).x - range) * (40.0 / range) + 4.0 * (turned.x + turned.y);
}

// How much of the key light, and what share of the ambient light, reach a point at that depth with that normal, as an
// octahedral direction: the mean of the pixel and its four neighbors, whose patterns of samples differ. Those that show
// a similar surface have the most weight; at edges, the pixel itself may show another one.
vec2 front_light(ivec2 pixel, float range, vec2 normal) {
  ivec2 last = textureSize(front_light_map, 0) - 1, offset = ivec2(1, 0);
  uvec2 found = texelFetch(front_light_map, pixel, 0).rg;
  float difference = unlikeness(found.y, range, normal);
  float weights = 1.0 / (0.02 + difference * difference);
  vec2 sum = weights * unpackHalf2x16(found.x);
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
