// SPDX-License-Identifier: Apache-2.0
// The share of light that shade takes from the floor; blending multiplies with the rest.
#include "frame.glsl"
layout(location = 0) in vec2 on_disc;
layout(location = 1) in float range;
layout(location = 2) flat in float darkness;
layout(location = 0) out vec4 color;

void main() {
  float inside = max(1.0 - dot(on_disc, on_disc), 0.0);
  float left = exp(-frame.fog.g * max(0.0, range - frame.fog.w));
  color = vec4(0.0, 0.0, 0.0, darkness * inside * inside * left);
}
