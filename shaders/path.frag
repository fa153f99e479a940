// SPDX-License-Identifier: Apache-2.0
// A path, in its flat color behind fog.
#include "frame.glsl"
layout(location = 0) in vec4 tint;
layout(location = 1) in vec3 world;
layout(location = 0) out vec4 color;

void main() {
  vec3 from_eye = world - frame.eye.xyz;
  float range = length(from_eye);
  color = vec4(through_fog(tint.rgb, from_eye / range, range), tint.a);
}
