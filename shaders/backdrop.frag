// SPDX-License-Identifier: Apache-2.0
// The surroundings: the floor, and beyond it the backdrop. HORIZON: the picture reaches the horizon.
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

void main() {
  vec3 sight = transpose(mat3(frame.view)) * vec3((2.0 * uv - 1.0) * frame.depth.zw, -1.0);
  vec3 direction = normalize(sight);
  vec3 light = backdrop(direction);
#if AROUND == AROUND_WATER && defined(HORIZON)
  light *= 1.0 + shafts(direction);
#endif
#if AROUND != AROUND_NONE
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
  color = vec4(light, 0.0);
}
