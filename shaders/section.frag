// SPDX-License-Identifier: Apache-2.0
// The spring whose middle is nearest gives a place of the cut its look.
layout(location = 0) in vec3 off;
layout(location = 1) flat in vec4 material;
layout(location = 0) out vec4 color;
layout(location = 0) uniform float reach;

void main() {
  float far = length(off) / reach;
  if (far > 1.0) discard;
  gl_FragDepth = 1.0 - far;
  color = material;
}
