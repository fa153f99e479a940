// SPDX-License-Identifier: Apache-2.0
// The box around each body's finite masses, in its own coordinates: one work group per body.
#include "bodies.glsl"
layout(local_size_x = 64) in;

struct Box {
  vec4 low, high;
};
layout(std430, binding = 11) writeonly buffer Boxes { Box boxes[]; };
layout(std430, binding = 12) readonly buffer MassOffsets { uint mass_offsets[]; };

shared vec3 lows[64];
shared vec3 highs[64];

void main() {
  uint body = gl_WorkGroupID.x;
  uint lane = gl_LocalInvocationID.x;
  vec3 low = vec3(1e30), high = vec3(-1e30);
  for (uint mass = mass_offsets[body] + lane; mass < mass_offsets[body + 1u]; mass += 64u) {
    vec3 p = position_of(mass);
    if (!all(lessThan(abs(p), vec3(1e9)))) continue;  // also false for NaN
    low = min(low, p);
    high = max(high, p);
  }
  lows[lane] = low;
  highs[lane] = high;
  for (uint half_count = 32u; half_count > 0u; half_count /= 2u) {
    barrier();
    if (lane < half_count) {
      lows[lane] = min(lows[lane], lows[lane + half_count]);
      highs[lane] = max(highs[lane], highs[lane + half_count]);
    }
  }
  if (lane == 0u) boxes[body] = Box(vec4(lows[0], 0.0), vec4(highs[0], 0.0));
}
