// SPDX-License-Identifier: Apache-2.0
// A quad of render/text/overlay.h as 6 vertices.
struct Quad {
  vec4 rectangle;   // x, y, width, height; pixels from the upper left corner
  vec4 source;
  vec4 color;
  vec4 edge;
  uint kind;
  float sharpness;
  uint map;
  uint padding;
};
layout(std430, binding = 11) readonly buffer Quads { Quad quads[]; };
layout(location = 0) uniform vec2 screen;  // pixels

layout(location = 0) out vec2 at;  // glyph: texel; otherwise 0 to 1
layout(location = 1) flat out uint index;
out gl_PerVertex { vec4 gl_Position; };

void main() {
  index = uint(gl_VertexID) / 6u;
  int vertex = gl_VertexID % 6;
  vec2 corner = vec2(vertex == 1 || vertex == 3 || vertex == 4, vertex == 2 || vertex == 4 || vertex == 5);
  Quad quad = quads[index];
  vec2 pixel = quad.rectangle.xy + corner * quad.rectangle.zw;
  at = quad.kind == 0u ? quad.source.xy + corner * quad.source.zw : corner;
  gl_Position = vec4(2.0 * pixel.x / screen.x - 1.0, 1.0 - 2.0 * pixel.y / screen.y, 0.0, 1.0);
}
