// SPDX-License-Identifier: Apache-2.0
// What the points of a finer skin have: means of what masses have (render/subdivision.h), NUMBERS each.
layout(local_size_x = 64) in;
#if NUMBERS == 3
layout(std430, binding = 1) readonly buffer OfMasses { float of_masses[]; };  // positions
#else
layout(std430, binding = 10) readonly buffer OfMasses { float of_masses[]; };  // values to color by
#endif
layout(std430, binding = 11) readonly buffer Ends { uint ends[]; };
layout(std430, binding = 12) readonly buffer Masses { uint masses[]; };
layout(std430, binding = 13) readonly buffer Weights { float weights[]; };
layout(std430, binding = 14) writeonly buffer Points { float points[]; };
layout(location = 0) uniform uint count;

void main() {
  uint point = gl_GlobalInvocationID.x + gl_GlobalInvocationID.y * gl_NumWorkGroups.x * gl_WorkGroupSize.x;
  if (point >= count) return;
  float sums[NUMBERS];
  for (int k = 0; k < NUMBERS; ++k) sums[k] = 0.0;
  for (uint i = point == 0u ? 0u : ends[point - 1u]; i < ends[point]; ++i)
    for (int k = 0; k < NUMBERS; ++k) sums[k] += weights[i] * of_masses[uint(NUMBERS) * masses[i] + uint(k)];
  for (int k = 0; k < NUMBERS; ++k) points[uint(NUMBERS) * point + uint(k)] = sums[k];
}
