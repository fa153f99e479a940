// SPDX-License-Identifier: Apache-2.0
// A corner of a skin in the picture, for depth alone.
#include "frame.glsl"
#include "bodies.glsl"
layout(location = 0) in vec3 position;  // in the body's coordinates
layout(location = 1) in uint body;
out gl_PerVertex {
  vec4 gl_Position;
  float gl_ClipDistance[1];
};

void main() {
  Placement placement = placements[body];
  vec3 world = position + placement.offset;
  gl_Position = frame.view_projection * vec4(world, 1.0);
  gl_ClipDistance[0] = placement.cut.w - dot(placement.cut.xyz, world);
}
