// SPDX-License-Identifier: Apache-2.0
// A mass, shaded as a ball.
#include "frame.glsl"
#include "shadow.glsl"
#include "shading.glsl"
layout(location = 0) in vec2 on_ball;
layout(location = 1) flat in vec3 center;
layout(location = 2) flat in vec3 albedo;
layout(location = 3) flat in float ball_radius;
layout(location = 0) out vec4 color;

void main() {
  float squared = dot(on_ball, on_ball);
  float edge = fwidth(sqrt(squared));
  float cover = clamp((1.0 - sqrt(squared)) / max(edge, 1e-5) + 0.5, 0.0, 1.0);
  int covered = int(cover * float(SAMPLES) + 0.5);
  if (covered == 0) discard;
  gl_SampleMask[0] = (1 << covered) - 1;
  vec3 to_eye = normalize(frame.eye.xyz - center);
  vec3 right = normalize(cross(abs(to_eye.z) > 0.99 ? vec3(1.0, 0.0, 0.0) : vec3(0.0, 0.0, 1.0), to_eye));
  vec3 up = cross(to_eye, right);
  vec3 normal = normalize(right * on_ball.x + up * on_ball.y + to_eye * sqrt(max(0.0, 1.0 - squared)));
  vec3 world = center + ball_radius * normal;
  vec4 clip = frame.view_projection * vec4(world, 1.0);
  gl_FragDepth = clip.z / clip.w;
  vec3 key = frame.key_light.rgb * key_visibility(world, normal, pixel_noise(gl_FragCoord.xy));
  vec3 light = lit(Surface(albedo, normal, 0.3, 0.1), to_eye, key, 0.8);
  color = vec4(through_fog(light, -to_eye, length(world - frame.eye.xyz)), 0.0);
}
