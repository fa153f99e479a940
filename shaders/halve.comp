// SPDX-License-Identifier: Apache-2.0
// A texel of a coarser level of a square texture: the mean of those it covers in the finer level.
layout(local_size_x = 8, local_size_y = 8) in;
layout(binding = 0) uniform sampler2D source;
layout(binding = 0) writeonly uniform image2D coarser;
layout(location = 0) uniform int finer_level;

void main() {
  ivec2 at = ivec2(gl_GlobalInvocationID.xy), size = imageSize(coarser);
  if (any(greaterThanEqual(at, size))) return;
  imageStore(coarser, at, textureLod(source, (vec2(at) + 0.5) / vec2(size), float(finer_level)));
}
