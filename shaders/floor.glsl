// SPDX-License-Identifier: Apache-2.0
// The ground on land and the sand under water. Needs frame.glsl, caustics.glsl.
layout(binding = 5) uniform sampler2D sand_tile;    // slope x, y, grain, patches
layout(binding = 6) uniform sampler2D ground_light_map;

// 1 on lines `period` apart, smoothed over `pixel` meters. Fades out before lines are too dense to be resolved.
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

// The tile at two sizes that suit the viewing distance. `scale` = tiles per octave.
vec4 ground_tile(vec2 point, float scale) {
#if OCTAVES == 1
  return texture(sand_tile, point * (scale / frame.octave.x));
#else
  return mix(texture(sand_tile, point * (scale / frame.octave.x)), texture(sand_tile, point * (scale / frame.octave.y)),
             frame.octave.z);
#endif
}

// Lines at a power of ten of meters that suits the distance; the next finer ones fade in as the camera comes closer.
float meter_lines(vec2 point, vec2 pixel) {
  float decade = log(frame.water.w * 0.12) / log(10.0);
  float period = pow(10.0, floor(decade));
  float finer = 1.0 - fract(decade);
  float width = 0.0035 * frame.water.w * 0.3;
  return max(0.35 * finer * lines(point, period, pixel, width * 0.5), 0.5 * lines(point, 10.0 * period, pixel, width));
}

#ifdef PRINTS
#include "prints.glsl"
layout(binding = 13) uniform sampler2D print_relief;  // print_relief.comp

// Slope x, y, how much the ground is pressed, share of the key light.
vec4 print_at(vec2 place) {
  vec2 at = (place - prints.map.xy) / prints.map.z;
  vec4 there = texture(print_relief, at);
  there.xy = slope_of(there.xy);
  return all(greaterThan(at, vec2(0.0))) && all(lessThan(at, vec2(1.0))) ? there : vec4(0.0, 0.0, 0.0, 1.0);
}
#endif

// Dry ground without lines: patches, ripples and grain at three sizes. `open` = share of ambient light that
// occlusion leaves. `place` = the point in the picture, where prints are.
vec3 soil(vec2 point, vec2 place, float key, float open, out vec3 light) {
  vec4 fine = ground_tile(point, 1.1), finest = ground_tile(point.yx, 6.7);
  vec4 broad = ground_tile(mat2(0.8, 0.6, -0.6, 0.8) * point, 0.09);
  vec2 slope = (fine.xy - 0.5) * 0.75 + (broad.xy - 0.5) * 0.45 + (finest.yx - 0.5) * 0.30;
#ifdef PRINTS
  vec4 print = print_at(place);
  slope = slope * (1.0 - 0.6 * print.z) + print.xy;
  key *= print.w;
  open *= 1.0 - 0.30 * print.z;
#endif
  vec3 normal = normalize(vec3(-slope, 1.0));
  float n_l = max(dot(normal, frame.to_key.xyz), 0.0);
  light = frame.key_light.rgb * key * n_l / 1.6 + frame.sky_light.rgb * open * (0.7 + 0.3 * normal.z);
  float dry = smoothstep(0.30, 0.66, broad.a);
  vec3 color = mix(frame.floor_color.rgb * vec3(0.70, 0.75, 0.74), frame.floor_color.rgb * vec3(1.20, 1.07, 0.92), dry);
  float grain = 0.12 + 0.50 * fine.z + 0.70 * fine.a + 0.30 * finest.z + 0.26 * finest.a;
#ifdef PRINTS
  // Pressed sand is smoother and darker.
  grain = mix(grain, 0.36 + 0.70 * fine.a, 0.6 * print.z) * (1.0 - 0.12 * print.z);
#endif
  return color * grain;
}

// `pixel` = size of a pixel on the floor [m].
vec3 land(vec2 point, vec2 pixel, float open) {
  vec3 light;
  vec3 color = soil(point, point, key_on_floor(point), open, light);
  return mix(color, frame.line_color.rgb, frame.line_color.w * meter_lines(point, pixel)) * light;
}

// Robots swim far above the sand, so there is no ambient occlusion.
vec3 sand(vec2 point) {
  float key = key_on_floor(point);
  vec3 tile = ground_tile(point, 1.9).xyz;
  vec2 slope = (tile.xy - 0.5) * 1.1;
  vec3 normal = normalize(vec3(-slope, 1.0));
  float n_l = max(dot(normal, frame.to_key.xyz), 0.0);
  // Waves come in groups: the pattern is strong in some places and faint in others.
  float broad = ground_tile(mat2(0.8, 0.6, -0.6, 0.8) * point, 0.11).a;
  float focused = caustics(surface_point(vec3(point, frame.ground.w)), 0.0, 0.4);
  focused = mix(1.0, focused, 0.15 + 1.15 * smoothstep(0.34, 0.64, broad));
  vec3 light = frame.key_light.rgb * key * n_l / 1.6 * focused + frame.sky_light.rgb * (0.7 + 0.3 * normal.z);
  return frame.floor_color.rgb * (0.62 + 0.5 * tile.z + 0.28 * broad) * light;
}
