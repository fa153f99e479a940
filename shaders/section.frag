// SPDX-License-Identifier: Apache-2.0
// Each point of the cut takes the material of the spring with the nearest middle: the depth test compares distances.
layout(location = 0) in vec3 offset;
layout(location = 1) flat in vec4 material;
layout(location = 0) out vec4 color;
layout(location = 0) uniform float reach;

void main() {
  float far = length(offset) / reach;
  if (far > 1.0) discard;
  gl_FragDepth = 1.0 - far;
  color = material;
}
