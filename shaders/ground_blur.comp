// SPDX-License-Identifier: Apache-2.0
// Averages the 4 x 4 sample patterns of ground_light.comp.
layout(local_size_x = 8, local_size_y = 8) in;
layout(binding = 0) uniform sampler2D source;
layout(binding = 0, r16f) writeonly uniform image2D map;

void main() {
  ivec2 at = ivec2(gl_GlobalInvocationID.xy), size = imageSize(map);
  if (any(greaterThanEqual(at, size))) return;
  vec2 texel = 1.0 / vec2(size), uv = (vec2(at) + 0.5) * texel;
  vec4 sum = textureGather(source, uv + texel * vec2(-0.5, -0.5)) + textureGather(source, uv + texel * vec2(1.5, -0.5)) +
             textureGather(source, uv + texel * vec2(-0.5, 1.5)) + textureGather(source, uv + texel * vec2(1.5, 1.5));
  imageStore(map, at, vec4(dot(sum, vec4(1.0 / 16.0))));
}
