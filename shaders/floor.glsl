// SPDX-License-Identifier: Apache-2.0
// The ground on land and the sand under water. Needs frame.glsl, caustics.glsl.
layout(binding = 5) uniform sampler2D sand_tile;    // slope x, y, grain
layout(binding = 6) uniform sampler2D ground_light_map;

// 1 on lines `period` apart, smoothed over `pixel` metres. Fades out before lines are too dense to be resolved.
float lines(vec2 point, float period, vec2 pixel, float width) {
  vec2 off = abs(fract(point / period + 0.5) - 0.5) * period;
  vec2 on = 1.0 - smoothstep(vec2(0.0), pixel, off - 0.5 * max(vec2(width), pixel));
  on *= clamp(width / pixel, 0.35, 1.0) * smoothstep(0.25, 0.1, pixel / period);
  return max(on.x, on.y);
}

float key_on_floor(vec2 point) {
  vec2 at = (point - frame.ground.xy) / frame.ground.z;
  if (any(lessThan(at, vec2(0.0))) || any(greaterThan(at, vec2(1.0)))) return 1.0;
  return textureLod(ground_light_map, at, 0.0).r;
}

// `pixel` = size of a pixel on the floor [m], `open` = share of ambient light that occlusion leaves.
vec3 land(vec2 point, vec2 pixel, float open) {
  float key = key_on_floor(point);
  vec3 light = frame.key_light.rgb * key * frame.to_key.z / 1.6 + frame.sky_light.rgb * open;
  // Lines at a power of ten of metres that suits the distance; the next finer ones fade in as the camera comes closer.
  float decade = log(frame.water.w * 0.12) / log(10.0);
  float period = pow(10.0, floor(decade));
  float finer = 1.0 - fract(decade);
  float width = 0.0035 * frame.water.w * 0.3;
  float line = max(0.45 * finer * lines(point, period, pixel, width * 0.5), 0.55 * lines(point, 10.0 * period, pixel, width));
  return mix(frame.floor_color.rgb, frame.line_color.rgb, line) * light;
}

// Robots swim far above the sand, so there is no ambient occlusion.
vec3 sand(vec2 point) {
  float key = key_on_floor(point);
#if OCTAVES == 1
  vec3 tile = texture(sand_tile, point * (1.9 / frame.octave.x)).rgb;
#else
  vec3 tile = mix(texture(sand_tile, point * (1.9 / frame.octave.x)).rgb,
                  texture(sand_tile, point * (1.9 / frame.octave.y)).rgb, frame.octave.z);
#endif
  vec2 slope = (tile.xy - 0.5) * 1.1;
  vec3 normal = normalize(vec3(-slope, 1.0));
  float n_l = max(dot(normal, frame.to_key.xyz), 0.0);
  vec3 light = frame.key_light.rgb * key * n_l / 1.6 * caustics(vec3(point, frame.ground.w), 0.4) +
               frame.sky_light.rgb * (0.7 + 0.3 * normal.z);
  return frame.floor_color.rgb * (0.75 + 0.5 * tile.z) * light;
}
