// SPDX-License-Identifier: Apache-2.0
// The surroundings: the floor, and beyond it the backdrop. HORIZON: the picture reaches the horizon.
// FAR_PART: only what is beyond the floor.
#include "frame.glsl"
#include "caustics.glsl"
#include "floor.glsl"
#include "occlusion.glsl"
layout(location = 0) in vec2 uv;
layout(location = 0) out vec4 color;

// Beams of light in the water, relative to the mean: the pattern of the caustics, summed along the line of sight.
float shafts(vec3 direction) {
  float sum = 0.0;
  for (int i = 1; i <= 6; ++i) {
    vec3 point = frame.eye.xyz + direction * frame.water.w * (0.4 + 0.45 * float(i));
    vec2 surface_point = point.xy - frame.to_key.xy / frame.to_key.z * point.z;
    sum += textureLod(caustics_tile, surface_point * (0.8 / frame.octave.x), 3.0).r - 1.0;
  }
  return 0.30 * sum / 6.0 * smoothstep(-0.05, 0.25, direction.z) * 2.0;
}

// The sky over land: haze at the horizon, blue above, light around the sun, thin clouds, and hills far away.
vec3 sky(vec3 direction) {
  float high = max(direction.z, 0.0);
  vec3 haze = frame.backdrop_high.rgb, zenith = frame.backdrop_low.rgb;
  vec3 light = mix(haze, zenith, 1.0 - exp(-frame.sky_light.w * high));
  float sun = max(dot(direction, frame.to_key.xyz), 0.0);
  float bright = sun * sun * sun;
  light += haze * (0.28 * bright + 0.5 * pow(sun, 48.0)) * frame.key_light.rgb / frame.key_light.g;
  light += 0.7 * frame.key_light.rgb * smoothstep(0.9988, 0.9993, sun);
  vec2 above = direction.xy / (high + 0.16);
  float clouds = texture(sand_tile, above * vec2(0.05, 0.11)).a * 0.65 + texture(sand_tile, above.yx * 0.23).a * 0.35;
  light = mix(light, haze * (1.12 + 0.5 * bright), 0.55 * smoothstep(0.46, 0.72, clouds) * smoothstep(0.02, 0.22, high));
  vec2 around = normalize(direction.xy + vec2(1e-6));
  float far_hills = 0.22 * (textureLod(sand_tile, around * 0.23, 2.0).a - 0.36);
  float near_hills = 0.17 * (textureLod(sand_tile, around.yx * 0.41 + 0.3, 2.0).a - 0.42);
  float edge = max(fwidth(direction.z), 1e-5);
  vec3 ground = frame.floor_color.rgb * (0.5 * frame.sky_light.rgb + 0.35 * frame.key_light.rgb);
  float low = smoothstep(0.03, -0.005, direction.z);  // haze lies in the plain
  light = mix(light, mix(ground, haze, mix(0.72, 1.0, low)), clamp((far_hills - direction.z) / edge + 0.5, 0.0, 1.0));
  return mix(light, mix(ground, haze, mix(0.48, 1.0, low)), clamp((near_hills - direction.z) / edge + 0.5, 0.0, 1.0));
}

void main() {
  vec3 sight = sight_through(uv);
  vec3 direction = normalize(sight);
  vec3 light = backdrop(direction);
#if AROUND == AROUND_WATER && defined(HORIZON)
  light *= 1.0 + shafts(direction);
#elif AROUND == AROUND_LAND && defined(HORIZON)
  light = sky(direction);
#endif
#if AROUND != AROUND_NONE && !defined(FAR_PART)
  // `sight` has length 1 along the camera's axis, so `steps` is the depth along that axis.
  float steps = (frame.ground.w - frame.eye.z) / sight.z;
  vec3 point = frame.eye.xyz + steps * sight;
  vec2 pixel = max(fwidth(point.xy), vec2(1e-6));
#if AROUND == AROUND_LAND
  vec3 ground = land(point.xy, pixel, openness(gl_FragCoord.xy, steps));
#else
  vec3 ground = sand(point.xy);
#endif
  if (steps > 0.0 && steps < 0.5 * frame.depth.y) light = through_fog(ground, direction, steps * length(sight));
#endif
#if defined(CATCH_SHADOWS)
  // An unseen floor: the share of its light that bodies leave.
  float steps = (frame.ground.w - frame.eye.z) / sight.z;
  if (steps > 0.0 && steps < 0.5 * frame.depth.y) {
    float key = frame.key_light.g * frame.to_key.z / 1.6, sky = frame.sky_light.g;
    vec2 point = (frame.eye.xyz + steps * sight).xy, at = (point - frame.ground.xy) / frame.ground.z;
    // Away from the bodies, occlusion is that of the picture's edge.
    bool near = all(greaterThan(at, vec2(0.0))) && all(lessThan(at, vec2(1.0)));
    float left = key * key_on_floor(point) + sky * (near ? openness(gl_FragCoord.xy, steps) : 1.0);
    light *= left / (key + sky);
  }
#endif
  color = vec4(light, 0.0);
}
