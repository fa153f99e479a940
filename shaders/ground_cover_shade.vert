// SPDX-License-Identifier: Apache-2.0
// The soft shade of a plant or a stone on the floor: a disc that the light's direction stretches.
#include "frame.glsl"
#include "ground_cover.glsl"
layout(std430, binding = 13) readonly buffer Items { Item items[]; };
layout(std430, binding = 14) readonly buffer Lists { uint lists[]; };
layout(location = 0) uniform uint first;    // of the list
layout(location = 1) uniform vec2 shape;    // radius, as a share of the height; darkness

layout(location = 0) out vec2 on_disc;
layout(location = 1) out float range;
layout(location = 2) flat out float darkness;
out gl_PerVertex { vec4 gl_Position; };

void main() {
  Item item = items[lists[first + uint(gl_InstanceID)]];
  int vertex = gl_VertexID % 6;
  on_disc = 2.0 * vec2(vertex == 1 || vertex == 3 || vertex == 4, vertex == 2 || vertex == 4 || vertex == 5) - 1.0;
  vec2 fall = -frame.to_key.xy / max(frame.to_key.z, 0.2) * item.height;
  float reach = length(fall);
  vec2 axis = reach > 1e-6 ? fall / reach : vec2(1.0, 0.0);
  float radius = shape.x * item.height;
  vec2 at = item.foot.xy + 0.4 * fall + axis * on_disc.x * (radius + 0.5 * reach) +
            vec2(-axis.y, axis.x) * on_disc.y * radius;
  vec3 world = vec3(at, frame.ground.w);
  range = distance(world, frame.eye.xyz);
  darkness = shape.y;
  gl_Position = frame.view_projection * vec4(world, 1.0);
}
