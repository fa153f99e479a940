// SPDX-License-Identifier: Apache-2.0
// Each point of a cut takes the material of its body's spring with the nearest middle: the depth test compares distances.
#include "frame.glsl"
#include "cut.glsl"
#include "cut_map.glsl"
layout(location = 0) in vec3 offset;
layout(location = 1) flat in vec4 material;
layout(location = 2) flat in uint body;
layout(location = 0) out vec4 color;
layout(location = 0) uniform float reach;

void main() {
  float far = length(offset) / reach;
  if (far > 1.0 || !shows_inside(ivec2(gl_FragCoord.xy), body)) discard;
  gl_FragDepth = 1.0 - far;
  color = material;
}
