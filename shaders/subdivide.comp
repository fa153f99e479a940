// SPDX-License-Identifier: Apache-2.0
// The points of a finer skin: means of masses (render/subdivision.h).
layout(local_size_x = 64) in;
layout(std430, binding = 1) readonly buffer Positions { float positions[]; };
layout(std430, binding = 11) readonly buffer Ends { uint ends[]; };
layout(std430, binding = 12) readonly buffer Masses { uint masses[]; };
layout(std430, binding = 13) readonly buffer Weights { float weights[]; };
layout(std430, binding = 14) writeonly buffer Points { float points[]; };
layout(location = 0) uniform uint count;

void main() {
  uint point = gl_GlobalInvocationID.x + gl_GlobalInvocationID.y * gl_NumWorkGroups.x * gl_WorkGroupSize.x;
  if (point >= count) return;
  vec3 sum = vec3(0.0);
  for (uint i = point == 0u ? 0u : ends[point - 1u]; i < ends[point]; ++i) {
    uint mass = masses[i];
    sum += weights[i] * vec3(positions[3u * mass], positions[3u * mass + 1u], positions[3u * mass + 2u]);
  }
  points[3u * point] = sum.x;
  points[3u * point + 1u] = sum.y;
  points[3u * point + 2u] = sum.z;
}
