// SPDX-License-Identifier: Apache-2.0
// An arrow: brightly and evenly shaded, because it is a sign and not an object.
#include "frame.glsl"
#include "shading.glsl"
layout(location = 0) in float across;
layout(location = 1) flat in vec3 side;
layout(location = 2) flat in vec3 axis;
layout(location = 3) flat in vec3 albedo;
layout(location = 4) in vec3 world;
layout(location = 0) out vec4 color;

void main() {
  vec3 front = cross(side, axis);
  vec3 to_eye = normalize(frame.eye.xyz - world);
  if (dot(front, to_eye) < 0.0) front = -front;
  float height = sqrt(max(0.0, 1.0 - across * across));
  vec3 normal = normalize(side * across + front * (height + 0.2));
  float shade = 0.62 + 0.38 * max(dot(normal, frame.to_key.xyz), 0.0);
  color = vec4(albedo * shade, 0.0);
}
