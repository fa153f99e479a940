// SPDX-License-Identifier: Apache-2.0
// A corner of a skin in the light's view.
#include "frame.glsl"
#include "bodies.glsl"
layout(location = 0) in vec3 position;
layout(location = 1) in uint body;

out gl_PerVertex {
  vec4 gl_Position;
  float gl_ClipDistance[1];
};

void main() {
  Placement placement = placements[body];
  vec3 world = position + placement.offset;
  vec3 on_map = (frame.shadow * vec4(world, 1.0)).xyz;
  bool hidden = (placement.flags & PLACEMENT_HIDDEN) != 0u;
  gl_Position = hidden ? vec4(2.0, 2.0, 2.0, 1.0) : vec4(2.0 * on_map.xy - 1.0, on_map.z, 1.0);
  gl_ClipDistance[0] = placement.cut.w - dot(placement.cut.xyz, world);
}
