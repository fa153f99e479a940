// SPDX-License-Identifier: Apache-2.0
// One segment of a path: a strip of 6 vertices with a constant width on the screen.
#include "frame.glsl"
#include "bodies.glsl"
#include "ribbon.glsl"
#define NO_BODY 0xffffffffu
struct PathPoint {
  vec4 position;  // in the body's coordinates; w = bits of the body's index
  vec4 color;  // linear, opacity; opacity < 0 = the path ends here
};
layout(std430, binding = 11) readonly buffer PathPoints { PathPoint points[]; };
layout(location = 0) uniform float width;  // [pixels]

layout(location = 0) out vec4 tint;
layout(location = 1) out vec3 world;
out gl_PerVertex { vec4 gl_Position; };

void main() {
  int segment = gl_VertexID / 6;
  vec2 corner = ribbon_corner(gl_VertexID % 6);
  PathPoint a = points[segment], b = points[segment + 1];
  uint body = floatBitsToUint(a.position.w);
  Placement placement = Placement(vec3(0.0), 0u, vec4(0.0, 0.0, 0.0, 1.0));  // without a body, points are in the picture's coordinates
  if (body != NO_BODY) placement = placements[body];
  vec3 point = mix(a.position.xyz, b.position.xyz, corner.x) + placement.offset;
  vec3 side = across_of(normalize(b.position.xyz - a.position.xyz + vec3(1e-12)), frame.eye.xyz - point);
  world = point + side * corner.y * 0.5 * width * pixel_size(point);
  tint = vec4(a.color.rgb, mix(abs(a.color.a), abs(b.color.a), corner.x));
  gl_Position = frame.view_projection * vec4(world, 1.0);
  if ((placement.flags & PLACEMENT_HIDDEN) != 0u || a.color.a < 0.0) gl_Position = vec4(2.0, 2.0, 2.0, 1.0);
}
