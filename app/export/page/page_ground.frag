// SPDX-License-Identifier: Apache-2.0
// The key light on the floor as a map, as shaders/ground_light.comp makes it.
#define SHADOW_BLOCKERS 12
#define SHADOW_TAPS 24
#include "frame.glsl"
#include "shadow.glsl"
layout(location = 0) in vec2 uv;
layout(location = 0) out vec4 light;

void main() {
  vec3 point = vec3(frame.ground.xy + frame.ground.z * uv, frame.ground.w);
  light = vec4(key_visibility(point, vec3(0.0, 0.0, 1.0), 0.1));
}
