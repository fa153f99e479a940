// SPDX-License-Identifier: Apache-2.0
// An arrow of 18 vertices: a strip for its shaft, a triangle for its head, and before them the same, larger and dark, as
// an edge that sets it off from anything behind it.
#include "frame.glsl"
#include "bodies.glsl"
#include "ribbon.glsl"
struct Arrow {
  vec4 from;    // in the body's coordinates; w = bits of the body's index
  vec4 vector;
  vec4 color;   // linear
};
layout(std430, binding = 11) readonly buffer Arrows { Arrow arrows[]; };

layout(location = 0) out float across;
layout(location = 1) flat out vec3 side;
layout(location = 2) flat out vec3 axis;
layout(location = 3) flat out vec3 albedo;
layout(location = 4) out vec3 world;
out gl_PerVertex {
  vec4 gl_Position;
  float gl_ClipDistance[1];
};

void main() {
  Arrow arrow = arrows[gl_VertexID / 18];
  int vertex = gl_VertexID % 9;
  bool is_edge = gl_VertexID % 18 < 9;
  Placement placement = placements[floatBitsToUint(arrow.from.w)];
  vec3 tail = arrow.from.xyz + placement.offset;
  float size = length(arrow.vector.xyz);
  float pixel = pixel_size(tail);
  // Slender, but never thinner than a visible line.
  float shaft = max(0.022 * size, 0.9 * pixel);
  float head = min(max(5.0 * shaft, 6.0 * pixel), 0.6 * size);
  float grown = is_edge ? 1.1 * pixel : 0.0;
  axis = arrow.vector.xyz / max(size, 1e-12);
  side = across_of(axis, frame.eye.xyz - tail);
  if (vertex < 6) {
    vec2 corner = ribbon_corner(vertex);
    across = corner.y;
    world = tail + axis * corner.x * (size - 0.9 * head) + side * corner.y * (shaft + grown);
  } else {
    across = vertex == 8 ? 0.0 : float(2 * (vertex - 6) - 1);
    world = tail + axis * (vertex == 8 ? size + 2.6 * grown : size - head - grown) + side * across * (0.45 * head + 1.7 * grown);
  }
  albedo = is_edge ? vec3(0.004) : arrow.color.rgb;
  gl_Position = frame.view_projection * vec4(world, 1.0);
  if (is_edge) gl_Position.z *= 0.9995;  // behind the arrow (depth is reversed)
  if ((placement.flags & PLACEMENT_HIDDEN) != 0u || size < pixel) gl_Position = vec4(2.0, 2.0, 2.0, 1.0);
  gl_ClipDistance[0] = placement.cut.w - dot(placement.cut.xyz, tail);
}
