// SPDX-License-Identifier: Apache-2.0
// A particle with soft edges, or a bubble: a bright rim, and the light from above.
#include "frame.glsl"
layout(location = 0) in vec2 on_strip;
layout(location = 1) flat in float opacity;
layout(location = 2) flat in float slenderness;
layout(location = 3) flat in float hollow;
layout(location = 0) out vec4 color;

void main() {
  vec2 p = on_strip;
  p.x = max(abs(p.x) - (1.0 - slenderness), 0.0) / slenderness;  // a line with round ends
  float from_middle = dot(p, p);
  float soft = clamp(1.0 - from_middle, 0.0, 1.0);
  vec3 light = frame.sky_light.rgb + 0.35 * frame.key_light.rgb;
  vec2 off = on_strip - vec2(0.35, 0.40);
  float rim = smoothstep(0.35, 0.85, from_middle) * smoothstep(1.0, 0.90, from_middle);
  float bubble = 0.08 * step(from_middle, 1.0) + 0.75 * rim + exp(-18.0 * dot(off, off));
  color = vec4(light, 0.75 * opacity * mix(soft * soft, min(bubble, 1.0), hollow));
}
