// SPDX-License-Identifier: Apache-2.0
// Adds a picture's samples to the sum of the pictures that are seen through a lens.
layout(local_size_x = 8, local_size_y = 8) in;
layout(binding = 0) uniform sampler2DMS samples;
layout(binding = 0, rgba32f) uniform image2D sum;
layout(location = 0) uniform bool first;

void main() {
  ivec2 texel = ivec2(gl_GlobalInvocationID.xy);
  if (any(greaterThanEqual(texel, imageSize(sum)))) return;
  vec4 light = vec4(0.0);
  for (int i = 0; i < SAMPLES; ++i) light += clamp(texelFetch(samples, texel, i), 0.0, 16.0);
  vec4 before = first ? vec4(0.0) : imageLoad(sum, texel);
  imageStore(sum, texel, before + light / float(SAMPLES));
}
