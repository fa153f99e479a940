// SPDX-License-Identifier: Apache-2.0
// A particle with soft edges.
#include "frame.glsl"
layout(location = 0) in vec2 on_strip;
layout(location = 1) flat in float opacity;
layout(location = 2) flat in float slenderness;
layout(location = 0) out vec4 color;

void main() {
  vec2 p = on_strip;
  p.x = max(abs(p.x) - (1.0 - slenderness), 0.0) / slenderness;  // a line with round ends
  float soft = clamp(1.0 - dot(p, p), 0.0, 1.0);
  vec3 light = frame.sky_light.rgb + 0.35 * frame.key_light.rgb;
  color = vec4(light, 0.75 * opacity * soft * soft);
}
