// What is seen where nothing stands: the floor as far as it is seen, and the distance.
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
  vec3 across = vec3((2.0 * place - 1.0) * frame.depth.zw, -1.0);
  vec3 sight = transpose(mat3(frame.view)) * across;  // length 1 along the line of sight's axis
  float steps = (frame.ground.w - frame.eye.z) / sight.z;
  vec3 direction = normalize(sight);
  bool floor_seen = int(frame.water.x) != AROUND_NONE && steps > 0.0 && steps < 0.5 * frame.depth.y;
  if (!floor_seen) {
    vec3 light = backdrop(direction);
    if (frame.water.y > 0.0 && direction.z > -0.05) light *= 1.0 + shafts(direction);
    color = vec4(light, 0.0);
    return;
  }
  vec3 point = frame.eye.xyz + steps * sight;
  float range = steps * length(sight);
  vec2 pixel = max(fwidth(point.xy), vec2(1e-6));
  vec3 light = int(frame.water.x) == AROUND_LAND ? land(point.xy, pixel, openness(gl_FragCoord.xy, steps)) : sand(point.xy);
  color = vec4(through_fog(light, direction, range), 0.0);
}
