// SPDX-License-Identifier: Apache-2.0
// Averages the 4 x 4 sample patterns of occlusion.comp over texels at the same depth.
#include "frame.glsl"
layout(local_size_x = 8, local_size_y = 8) in;
layout(binding = 0) uniform sampler2D source;
layout(binding = 0, rg16f) writeonly uniform image2D map;

void main() {
  ivec2 texel = ivec2(gl_GlobalInvocationID.xy);
  if (any(greaterThanEqual(texel, imageSize(map)))) return;
  ivec2 last = textureSize(source, 0) - 1;
  float range = texelFetch(source, texel, 0).g, open = 1.0;
  // Not where nothing is seen. A loop, since renderers on the CPU compute both sides of an if.
  for (int once = 0; once < int(range < 0.99 * frame.depth.y); ++once) {
    float sum = 0.0, weights = 0.0;
    for (int y = -2; y < 2; ++y)
      for (int x = -2; x < 2; ++x) {
        vec2 value = texelFetch(source, clamp(texel + ivec2(x, y), ivec2(0), last), 0).rg;
        float weight = max(0.0, 1.0 - abs(value.g - range) / range * 30.0) + 1e-4;
        sum += weight * value.r;
        weights += weight;
      }
    open = sum / weights;
  }
  imageStore(map, texel, vec4(open, range, 0.0, 0.0));
}
