// SPDX-License-Identifier: Apache-2.0
// The corners of a ghost's faces, in the picture's coordinates.
#include "frame.glsl"
layout(std430, binding = 11) readonly buffer Corners { vec4 corners[]; };

layout(location = 0) out vec3 world;
out gl_PerVertex { vec4 gl_Position; };

void main() {
  world = corners[gl_VertexID].xyz;
  gl_Position = frame.view_projection * vec4(world, 1.0);
}
