// SPDX-License-Identifier: Apache-2.0
// What is seen where nothing stands: the floor as far as it is seen, and the distance. HORIZON: that can be seen.
#include "frame.glsl"
#include "caustics.glsl"
#include "floor.glsl"
#include "occlusion.glsl"
layout(location = 0) in vec2 place;
layout(location = 0) out vec4 color;

// Beams of light in the water, more or less than the mean: the caustics' pattern, gathered along the line of sight.
float shafts(vec3 direction) {
  float sum = 0.0;
  for (int i = 1; i <= 6; ++i) {
    vec3 point = frame.eye.xyz + direction * frame.water.w * (0.4 + 0.45 * float(i));
    vec2 place = point.xy - frame.to_key.xy / frame.to_key.z * point.z;
    sum += textureLod(caustics_tile, place * (0.8 / frame.octave.x), 3.0).r - 1.0;
  }
  return 0.30 * sum / 6.0 * smoothstep(-0.05, 0.25, direction.z) * 2.0;
}

void main() {
  vec3 sight = transpose(mat3(frame.view)) * vec3((2.0 * place - 1.0) * frame.depth.zw, -1.0);
  vec3 direction = normalize(sight);
  vec3 light = backdrop(direction);
#if AROUND == AROUND_WATER && defined(HORIZON)
  light *= 1.0 + shafts(direction);
#endif
#if AROUND != AROUND_NONE
  // `sight` has length 1 along the line of sight's axis, so that `steps` is the distance along that axis.
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
