// SPDX-License-Identifier: Apache-2.0
// A direction as two numbers from -1 to 1 (octahedral map; Meyer et al. 2010); packed_direction stores them in 32 bits.
vec2 octahedral(vec3 n) {
  vec2 p = n.xy / (abs(n.x) + abs(n.y) + abs(n.z));
  if (n.z < 0.0) p = (1.0 - abs(p.yx)) * mix(vec2(-1.0), vec2(1.0), greaterThanEqual(p, vec2(0.0)));
  return p;
}
uint packed_direction(vec3 n) { return packSnorm2x16(octahedral(n)); }

// The direction; not normalized.
vec3 unpacked_direction(uint bits) {
  vec2 p = unpackSnorm2x16(bits);
  float z = 1.0 - abs(p.x) - abs(p.y);
  float fold = max(-z, 0.0);
  return vec3(p + mix(vec2(fold), vec2(-fold), greaterThanEqual(p, vec2(0.0))), z);
}
