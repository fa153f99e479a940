// SPDX-License-Identifier: Apache-2.0
// A plant or a stone: key light with the shadows on the floor, light of the sky, and what shines through blades.
#include "frame.glsl"
#include "caustics.glsl"
#include "floor.glsl"
layout(location = 3) uniform vec3 low_color;   // at the foot
layout(location = 4) uniform vec3 high_color;  // at the tip
layout(location = 0) in vec3 world;
layout(location = 1) in vec3 normal;
layout(location = 2) in float along;
layout(location = 3) flat in float own;
layout(location = 0) out vec4 color;

void main() {
  vec3 from_eye = world - frame.eye.xyz;
  float range = length(from_eye);
  vec3 sight = from_eye / range;
  // The shadow that falls through this point, where it reaches the floor.
  vec2 fallen = world.xy - frame.to_key.xy / max(frame.to_key.z, 0.2) * (world.z - frame.ground.w);
  vec3 key = frame.key_light.rgb * key_on_floor(fallen);
#if AROUND == AROUND_WATER
  key *= caustics(surface_point(world), 0.0, 1.2);
#endif
  vec3 n = normalize(normal);
  vec3 albedo = mix(low_color, high_color, along) * (0.82 + 0.36 * own);
  float open = mix(0.35, 1.0, smoothstep(0.0, 0.7, along));
#ifdef PLANT
  if (dot(n, sight) > 0.0) n = -n;
  float n_l = dot(n, frame.to_key.xyz);
  float ahead = max(dot(sight, frame.to_key.xyz), 0.0);
  // Blades are thin: light that hits the other side comes through, in their color.
  float through = max(-n_l, 0.0) + 0.8 * ahead * ahead * ahead;
  vec3 light = key * (0.20 + 0.45 * max(n_l, 0.0) + 0.55 * through * vec3(1.0, 1.05, 0.75)) * mix(0.4, 1.0, along);
#else
  float grain = texture(sand_tile, (world.xy + world.z) / (0.5 * frame.octave.x)).a;
  albedo *= 0.55 + 0.9 * grain;
  albedo = mix(frame.floor_color.rgb * 1.1, albedo, smoothstep(0.02, 0.30, along));
  float n_l = dot(n, frame.to_key.xyz);
  vec3 light = key * max(n_l, 0.0) / 1.6;
#endif
  light += mix(frame.ground_light.rgb, frame.sky_light.rgb, 0.5 + 0.5 * n.z) * open;
  color = vec4(through_fog(albedo * light, sight, range), 0.0);
}
