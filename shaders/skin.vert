// SPDX-License-Identifier: Apache-2.0
// A corner of a skin in the picture.
#include "frame.glsl"
#include "bodies.glsl"
layout(location = 0) in vec3 position;  // in the body's coordinates
layout(location = 1) in uint body;
#ifdef ROUNDED
layout(std430, binding = 8) readonly buffer MassNormals { vec4 mass_normals[]; };
#endif
#if COLOR_BY == 2
layout(std430, binding = 10) readonly buffer MassValues { float mass_values[]; };
#endif

layout(location = 0) out vec3 local;
layout(location = 1) out vec3 world;
layout(location = 2) flat out uint flags;
#ifdef ROUNDED
layout(location = 3) out vec3 smooth_normal;
#if COLOR_BY == 0
layout(location = 7) out vec4 smooth_material;
#endif
#endif
#if COLOR_BY == 2
layout(location = 4) out float mass_value;
#endif
#ifdef CUT
layout(location = 5) flat out vec4 cut;
layout(location = 6) flat out uint body_index;
#endif

out gl_PerVertex {
  vec4 gl_Position;
  float gl_ClipDistance[1];
};

void main() {
  Placement placement = placements[body];
  local = position;
  world = position + placement.offset;
  flags = placement.flags;
#ifdef ROUNDED
  smooth_normal = mass_normals[2 * gl_VertexID].xyz;
#if COLOR_BY == 0
  smooth_material = mass_normals[2 * gl_VertexID + 1];
#endif
#endif
#if COLOR_BY == 2
  mass_value = mass_values[gl_VertexID];
#endif
  gl_Position = (flags & PLACEMENT_HIDDEN) != 0u ? vec4(0.0, 0.0, -1.0, 0.0) : frame.view_projection * vec4(world, 1.0);
  gl_ClipDistance[0] = placement.cut.w - dot(placement.cut.xyz, world);
#ifdef CUT
  cut = placement.cut;
  body_index = body;
  // From the other side, the cut is not visible.
  if (dot(cut.xyz, frame.eye.xyz) <= cut.w) gl_Position = vec4(0.0, 0.0, -1.0, 0.0);
#endif
}
