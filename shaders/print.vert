// SPDX-License-Identifier: Apache-2.0
// A print of render/scene.h, seen from above, as 6 vertices.
#include "prints.glsl"
struct Print {
  vec4 a_b;
  vec4 c_radius_depth;
};
layout(std430, binding = 11) readonly buffer Prints { Print all_prints[]; };

layout(location = 0) out vec2 world;
layout(location = 1) flat out vec4 a_b;
layout(location = 2) flat out vec4 c_radius_depth;
out gl_PerVertex { vec4 gl_Position; };

void main() {
  int vertex = gl_VertexID % 6;
  Print one = all_prints[gl_VertexID / 6];
  a_b = one.a_b;
  c_radius_depth = one.c_radius_depth;
  float room = 2.4 * c_radius_depth.z;  // to the end of the rim, see print.frag
  vec2 low = min(min(a_b.xy, a_b.zw), c_radius_depth.xy) - room, high = max(max(a_b.xy, a_b.zw), c_radius_depth.xy) + room;
  world = mix(low, high, vec2(vertex == 1 || vertex == 3 || vertex == 4, vertex == 2 || vertex == 4 || vertex == 5));
  gl_Position = vec4(2.0 * (world - prints.map.xy) / prints.map.z - 1.0, 0.5, 1.0);
}
