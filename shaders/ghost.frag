// SPDX-License-Identifier: Apache-2.0
// A ghost: one color, thin where it faces the eye and dense at its rim, as a soap bubble is.
#include "frame.glsl"
layout(location = 0) uniform vec4 tint;  // linear, opacity
layout(location = 0) in vec3 world;
layout(location = 0) out vec4 color;

void main() {
  vec3 from_eye = world - frame.eye.xyz;
  float range = length(from_eye);
  vec3 sight = from_eye / range;
  vec3 normal = normalize(cross(dFdx(world), dFdy(world)));
  float rim = 1.0 - abs(dot(normal, sight));
  float light = 0.75 + 0.25 * normal.z * -sign(dot(normal, sight));
  color = vec4(through_fog(light * tint.rgb, sight, range), tint.a * mix(0.75, 1.5, rim * rim));
}
