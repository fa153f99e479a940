// SPDX-License-Identifier: Apache-2.0
// Reads the result of front_light.comp. Needs bodies.glsl.
layout(binding = 11) uniform sampler2D front_light_map;

// How much of the key light reaches a point at that depth with that normal. At edges, the pixel's value may belong to
// another surface; then the most similar of the neighbouring pixels get the most weight.
float front_light(vec2 pixel, float range, vec3 normal) {
  const ivec2 offsets[5] = ivec2[](ivec2(0), ivec2(1, 0), ivec2(-1, 0), ivec2(0, 1), ivec2(0, -1));
  ivec2 at = ivec2(pixel), last = textureSize(front_light_map, 0) - 1;
  vec2 own = octahedral(normal);
  float sum = 0.0, weights = 0.0;
  for (int i = 0; i < 5; ++i) {
    vec4 found = texelFetch(front_light_map, clamp(at + offsets[i], ivec2(0), last), 0);
    vec2 turned = abs(found.zw - own);
    float difference = abs(found.y - range) * (40.0 / range) + 4.0 * (turned.x + turned.y);
    if (i == 0 && difference < 0.1) return found.x;
    float weight = 1.0 / (0.02 + difference * difference);
    sum += weight * found.x;
    weights += weight;
  }
  return sum / weights;
}
