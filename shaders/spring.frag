// SPDX-License-Identifier: Apache-2.0
// A spring, shaded as a round bar.
#include "frame.glsl"
#include "bodies.glsl"
#include "shadow.glsl"
#include "shading.glsl"
layout(location = 0) in vec3 world;
layout(location = 1) in float across;
layout(location = 2) flat in vec3 side;
layout(location = 3) flat in vec3 axis;
layout(location = 4) in vec4 material;
layout(location = 5) flat in uint flags;
layout(location = 0) out vec4 color;

void main() {
  vec3 from_eye = world - frame.eye.xyz;
  float range = length(from_eye);
  vec3 to_eye = -from_eye / range;
  vec3 front = cross(side, axis);
  if (dot(front, to_eye) < 0.0) front = -front;
  vec3 normal = side * across + front * sqrt(max(0.0, 1.0 - across * across));
  vec3 albedo = material.rgb * (1.0 + 0.35 * min(material.a, 0.0));
  if ((flags & PLACEMENT_FAULTY) != 0u) albedo = vec3(0.3);
  vec3 key = frame.key_light.rgb * key_visibility(world, normal, pixel_noise(gl_FragCoord.xy));
  vec3 light = lit(Surface(albedo, normal, 0.4, 0.3), to_eye, key, 0.8);
  float strength = max(material.a, 0.0);
  vec3 glow = frame.key_light.w * strength * strength * albedo * (0.35 + 0.65 * albedo);
  vec3 total = through_fog(light + glow, -to_eye, range);
  color = vec4(total, clamp(dot(glow, vec3(1.0)) / (dot(total, vec3(1.0)) + 1e-4), 0.0, 1.0));
}
