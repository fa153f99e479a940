// A skin's corner, set into the picture.
#include "frame.glsl"
#include "bodies.glsl"
layout(location = 0) in vec3 position;  // in the body's coordinates
layout(location = 1) in uint body;
layout(std430, binding = 8) readonly buffer MassNormals { vec4 mass_normals[]; };
layout(std430, binding = 10) readonly buffer MassValues { float mass_values[]; };

layout(location = 0) out vec3 local;
layout(location = 1) out vec3 world;
layout(location = 2) out vec3 smooth_normal;
layout(location = 3) out float mass_value;
layout(location = 4) flat out uint flags;

out gl_PerVertex {
  vec4 gl_Position;
  float gl_ClipDistance[1];
};

void main() {
  Placement placement = placements[body];
  local = position;
  world = position + placement.offset;
  flags = placement.flags;
  // Unused buffers are bound with a single element, and reading past the end gives 0 or that element.
  smooth_normal = (flags & PLACEMENT_SMOOTH) != 0u ? mass_normals[gl_VertexID].xyz : vec3(0.0, 0.0, 1.0);
  mass_value = gl_VertexID < mass_values.length() ? mass_values[gl_VertexID] : 0.0;
  gl_Position = (flags & PLACEMENT_HIDDEN) != 0u ? vec4(0.0, 0.0, -1.0, 0.0) : frame.view_projection * vec4(world, 1.0);
  gl_ClipDistance[0] = frame.cut.w - dot(frame.cut.xyz, world);
}
