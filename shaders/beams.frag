// SPDX-License-Identifier: Apache-2.0
// The key light that water or air scatters into the line of sight, with the shadows of bodies in it. Added to the picture.
#include "frame.glsl"
#include "caustics.glsl"
layout(binding = 0) uniform sampler2D depths;  // of the nearest surfaces
layout(binding = 1) uniform sampler2DShadow shadow_map;
layout(location = 0) in vec2 uv;
layout(location = 0) out vec4 color;

const int steps = 16;

float arrives(vec3 point) {
  vec3 on_map = (frame.shadow * vec4(point, 1.0)).xyz;
  if (any(lessThan(on_map, vec3(0.0))) || any(greaterThan(on_map.xy, vec2(1.0)))) return 1.0;
  return textureLod(shadow_map, vec3(on_map.xy, min(on_map.z, 0.9999)), 0.0);
}

void main() {
  vec3 sight = sight_through(uv);
  float along = length(sight), distance_to_target = frame.water.w;
  float range = min(distance_of_depth(textureLod(depths, uv, 0.0).r) * along, 5.0 * distance_to_target);
  vec3 direction = sight / along;
  vec3 sum = vec3(0.0);
  for (int i = 0; i < steps; ++i) {
    float t = (float(i) + frame.lens.z) / float(steps) * range;
    vec3 point = frame.eye.xyz + t * direction;
    float light = arrives(point);
#if AROUND == AROUND_WATER
    float focused = textureLod(caustics_tile, surface_point(point) * (0.8 / frame.octave.x), 3.6).r;
    light *= focused * focused * focused * exp(0.35 * (point.z - frame.eye.z) / distance_to_target);
#else
    light *= exp(-3.0 * max(point.z - frame.ground.w, 0.0) / distance_to_target);
#endif
    sum += light * exp(-0.45 * frame.fog.rgb * t);
  }
  sum *= range / (float(steps) * distance_to_target);
  // Most of the light goes on nearly straight ahead (Henyey and Greenstein 1941).
  const float g = 0.72;
  float cosine = dot(direction, frame.to_key.xyz);
  float phase = (1.0 - g * g) / pow(1.0 + g * g - 2.0 * g * cosine, 1.5);
#if AROUND == AROUND_WATER
  vec3 scattering = vec3(0.0007, 0.0046, 0.0063);
#else
  vec3 scattering = vec3(0.0030, 0.0026, 0.0020);
#endif
  color = vec4(sum * (0.25 + phase) * scattering * frame.key_light.rgb, 0.0);
}
