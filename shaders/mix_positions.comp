// SPDX-License-Identifier: Apache-2.0
// Positions between those of two steps, one number per invocation.
layout(local_size_x = 64) in;

layout(std430, binding = 1) writeonly buffer Positions { float positions[]; };
layout(std430, binding = 11) readonly buffer Earlier { float earlier[]; };
layout(std430, binding = 12) readonly buffer Later { float later[]; };
layout(location = 0) uniform uint count;
layout(location = 1) uniform float share;

void main() {
  uint i = gl_GlobalInvocationID.x + gl_GlobalInvocationID.y * gl_NumWorkGroups.x * gl_WorkGroupSize.x;
  if (i >= count) return;
  // As the host computes it: no fused multiply and add.
  precise float way = later[i] - earlier[i];
  precise float part = share * way;
  precise float between = earlier[i] + part;
  positions[i] = between;
}
