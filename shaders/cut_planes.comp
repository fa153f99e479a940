// SPDX-License-Identifier: Apache-2.0
// The plane that cuts each body, in the picture's coordinates: one work group per body. render/cut.cpp computes the same
// on the CPU and explains it.
#define WRITES_PLACEMENTS
#include "bodies.glsl"
layout(local_size_x = 64) in;
layout(std430, binding = 11) readonly buffer RestPositions { float rest_positions[]; };
layout(std430, binding = 12) readonly buffer MassOffsets { uint mass_offsets[]; };
layout(location = 0) uniform int axis;
layout(location = 1) uniform bool below;
layout(location = 2) uniform float share;
layout(location = 3) uniform float shift;  // [m]

shared vec4 sums[3][64];

// The sums over all lanes, in every lane.
void add_up(vec4 a, vec4 b, vec4 c, out vec4 all[3]) {
  uint lane = gl_LocalInvocationID.x;
  barrier();
  sums[0][lane] = a;
  sums[1][lane] = b;
  sums[2][lane] = c;
  for (uint half_count = 32u; half_count > 0u; half_count /= 2u) {
    barrier();
    if (lane < half_count)
      for (int i = 0; i < 3; ++i) sums[i][lane] += sums[i][lane + half_count];
  }
  barrier();
  for (int i = 0; i < 3; ++i) all[i] = sums[i][0];
}

vec3 rest_of(uint mass) {
  return vec3(rest_positions[3u * mass], rest_positions[3u * mass + 1u], rest_positions[3u * mass + 2u]);
}

bool counts(vec3 point) { return all(lessThan(abs(point), vec3(1e9))); }  // also false for NaN

float norm_of(mat4 m) { return sqrt(dot(m[0], m[0]) + dot(m[1], m[1]) + dot(m[2], m[2]) + dot(m[3], m[3])); }

// The rotation of Horn 1987 from the sums of rest.x now, rest.y now, rest.z now; w, x, y, z.
vec4 rotation_of(vec3 x, vec3 y, vec3 z) {
  mat4 n = mat4(x.x + y.y + z.z, y.z - z.y, z.x - x.z, x.y - y.x,
                y.z - z.y, x.x - y.y - z.z, x.y + y.x, z.x + x.z,
                z.x - x.z, x.y + y.x, -x.x + y.y - z.z, y.z + z.y,
                x.y - y.x, z.x + x.z, y.z + z.y, -x.x - y.y + z.z);
  float size = norm_of(n);
  if (!(size > 1e-20)) return vec4(1.0, 0.0, 0.0, 0.0);
  mat4 power = n / size + mat4(1.0);
  power[0][0] += 1e-4;
  for (int i = 0; i < 16; ++i) {
    power = power * power;
    power /= norm_of(power);
  }
  vec4 best = power[0];
  for (int i = 1; i < 4; ++i)
    if (dot(power[i], power[i]) > dot(best, best)) best = power[i];
  return normalize(best);
}

vec3 turned(vec4 q, vec3 v) { return v + 2.0 * cross(q.yzw, cross(q.yzw, v) + q.x * v); }

void main() {
  uint body = gl_WorkGroupID.x;
  uint lane = gl_LocalInvocationID.x;
  uint begin = mass_offsets[body] + lane, end = mass_offsets[body + 1u];
  vec4 all[3];
  vec4 rest_sum = vec4(0.0), sum = vec4(0.0);
  for (uint mass = begin; mass < end; mass += 64u) {
    vec3 p = position_of(mass);
    if (!counts(p)) continue;
    rest_sum += vec4(rest_of(mass), 1.0);
    sum += vec4(p, 0.0);
  }
  add_up(rest_sum, sum, vec4(0.0), all);
  float count = max(all[0].w, 1.0);
  bool any_mass = all[0].w > 0.0;
  vec3 rest_center = all[0].xyz / count, center = all[1].xyz / count;
  vec4 x = vec4(0.0), y = vec4(0.0), z = vec4(0.0);
  for (uint mass = begin; mass < end; mass += 64u) {
    vec3 p = position_of(mass);
    if (!counts(p)) continue;
    vec3 rest = rest_of(mass) - rest_center;
    vec4 now = vec4(p - center, 0.0);
    x += rest.x * now;
    y += rest.y * now;
    z += rest.z * now;
  }
  add_up(x, y, z, all);
  vec3 direction = turned(rotation_of(all[0].xyz, all[1].xyz, all[2].xyz), vec3(axis == 0, axis == 1, axis == 2));
  float low = 1e30, high = -1e30;
  for (uint mass = begin; mass < end; mass += 64u) {
    vec3 p = position_of(mass);
    if (!counts(p)) continue;
    low = min(low, dot(direction, p));
    high = max(high, dot(direction, p));
  }
  barrier();
  sums[0][lane] = vec4(low, high, 0.0, 0.0);
  barrier();
  if (lane != 0u || !any_mass) return;
  for (uint i = 1u; i < 64u; ++i) {
    low = min(low, sums[0][i].x);
    high = max(high, sums[0][i].y);
  }
  float room = 1e-3 * (high - low);
  float place = mix(low - room, high + room, share) + shift + dot(direction, placements[body].offset);
  placements[body].cut = below ? vec4(-direction, -place) : vec4(direction, place);
}
