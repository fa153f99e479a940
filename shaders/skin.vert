// A skin's corner, set into the picture.
#include "frame.glsl"
#include "bodies.glsl"
layout(location = 0) in vec3 position;  // in the body's coordinates
layout(location = 1) in uint body;

layout(location = 0) out vec3 local;
layout(location = 1) out vec3 world;
layout(location = 2) flat out uint flags;

out gl_PerVertex {
  vec4 gl_Position;
  float gl_ClipDistance[1];
};

void main() {
  Placement placement = placements[body];
  local = position;
  world = position + placement.offset;
  flags = placement.flags;
  gl_Position = (flags & PLACEMENT_HIDDEN) != 0u ? vec4(0.0, 0.0, -1.0, 0.0) : frame.view_projection * vec4(world, 1.0);
  gl_ClipDistance[0] = frame.cut.w - dot(frame.cut.xyz, world);
}
