// SPDX-License-Identifier: Apache-2.0
// How much of the key light, a disc, reaches a point: percentage-closer soft shadows (Fernando 2005).
layout(binding = 1) uniform sampler2DShadow shadow_map;
#define SHADOW_DEPTHS_DECLARED
layout(binding = 2) uniform sampler2D shadow_depths;

#ifndef SHADOW_BLOCKERS
#define SHADOW_BLOCKERS 6
#define SHADOW_TAPS 8
#endif

// The i-th of n points spread over the unit disc (golden-angle spiral). Constant once loops are unrolled.
vec2 disc_point(int i, int n) {
  float angle = 2.39996323 * float(i);
  return sqrt((float(i) + 0.5) / float(n)) * vec2(cos(angle), sin(angle));
}

mat2 turned_by(float turn) { return mat2(cos(turn), sin(turn), -sin(turn), cos(turn)); }

// `noise` in [0, 1) rotates the pattern of samples. The point is moved along its normal, off its own surface.
float key_visibility(vec3 point, vec3 normal, float noise) {
  float texel = frame.shadow_size.x / float(textureSize(shadow_depths, 0).x);
  float slant = 1.0 - clamp(dot(normal, frame.to_key.xyz), 0.0, 1.0);
  vec3 on_map = (frame.shadow * vec4(point + normal * texel * (1.0 + 2.5 * slant), 1.0)).xyz;
  if (any(lessThan(on_map, vec3(0.0))) || any(greaterThan(on_map.xy, vec2(1.0)))) return 1.0;
  float receiver = min(on_map.z, 1.0) * frame.shadow_size.y;
  float beyond = max(0.0, on_map.z - 1.0) * frame.shadow_size.y;
#if SHADOW_BLOCKERS > 0
  float turn = 6.2831853 * noise;
#else
  const float turn = 0.4;
#endif
  mat2 turned = turned_by(turn);
  float search = frame.to_key.w * (0.35 * receiver + beyond) / frame.shadow_size.x;
#if SHADOW_BLOCKERS > 0
  float blockers = 0.0, sum = 0.0;
  for (int i = 0; i < SHADOW_BLOCKERS; ++i) {
    float d = textureLod(shadow_depths, on_map.xy + search * turned * disc_point(i, SHADOW_BLOCKERS), 0.0).r;
    if (d < min(on_map.z, 0.9999)) {
      blockers += 1.0;
      sum += d;
    }
  }
  if (blockers == 0.0) return 1.0;
  float gap = receiver + beyond - sum / blockers * frame.shadow_size.y;
#else
  float gap = 0.0;  // without a search for blockers, all edges are equally soft
#endif
  float radius = max(frame.to_key.w * gap / frame.shadow_size.x, 1.6 * texel / frame.shadow_size.x);
  // Without this, far samples would find a slanted receiver itself as a blocker.
  float reference = min(on_map.z, 0.9999) - 0.3 * radius * frame.shadow_size.x * slant / frame.shadow_size.y;
  float lit = 0.0;
  for (int i = 0; i < SHADOW_TAPS; ++i)
    lit += textureLod(shadow_map, vec3(on_map.xy + radius * turned * disc_point(i, SHADOW_TAPS), reference), 0.0);
  return lit / float(SHADOW_TAPS);
}
