// SPDX-License-Identifier: Apache-2.0
// A patch of render/scene.h as 6 vertices, at the height of the floor.
#include "frame.glsl"
struct Patch {
  vec4 disc;   // center x, y; radius
  vec4 slide;  // x, y
};
layout(std430, binding = 11) readonly buffer Patches { Patch patches[]; };

layout(location = 0) out vec2 on_disc;  // from the middle, in radii
layout(location = 1) out vec3 world;
layout(location = 2) flat out vec3 slide_and_radius;
out gl_PerVertex { vec4 gl_Position; };

void main() {
  int vertex = gl_VertexID % 6;
  Patch one = patches[gl_VertexID / 6];
  on_disc = 2.0 * vec2(vertex == 1 || vertex == 3 || vertex == 4, vertex == 2 || vertex == 4 || vertex == 5) - 1.0;
  world = vec3(one.disc.xy + one.disc.z * on_disc, frame.ground.w);
  slide_and_radius = vec3(one.slide.xy, one.disc.z);
  gl_Position = frame.view_projection * vec4(world, 1.0);
}
