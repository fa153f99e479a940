// SPDX-License-Identifier: Apache-2.0
// The key light on the floor as a map, so that soft shadows are computed once per texel and not once per pixel.
#include "frame.glsl"
#include "shadow.glsl"
layout(local_size_x = 8, local_size_y = 8) in;
layout(binding = 0, r16f) writeonly uniform image2D map;

void main() {
  ivec2 texel = ivec2(gl_GlobalInvocationID.xy), size = imageSize(map);
  if (any(greaterThanEqual(texel, size))) return;
  vec2 uv = (vec2(texel) + 0.5) / vec2(size);
  vec3 point = vec3(frame.ground.xy + frame.ground.z * uv, frame.ground.w);
  // Neighboring texels use different sample patterns, repeating every 4 x 4; ground_blur.comp averages them.
  int cell = (texel.x & 3) + 4 * ((texel.y ^ (texel.x << 1)) & 3);
  imageStore(map, texel, vec4(key_visibility(point, vec3(0.0, 0.0, 1.0), (float(cell) + 0.5) / 16.0)));
}
