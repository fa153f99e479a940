// SPDX-License-Identifier: Apache-2.0
// One triangle that covers the picture, at the farthest depth.
layout(location = 0) out vec2 uv;  // 0 to 1
out gl_PerVertex { vec4 gl_Position; };

void main() {
  uv = vec2(gl_VertexID == 1 ? 2.0 : 0.0, gl_VertexID == 2 ? 2.0 : 0.0);
  gl_Position = vec4(2.0 * uv - 1.0, 0.0, 1.0);
}
