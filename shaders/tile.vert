// SPDX-License-Identifier: Apache-2.0
// A tile of render/scene.h as 6 vertices.
#include "frame.glsl"
struct Tile {
  vec4 center, half_width, half_height;
  vec4 fill, frame;  // linear
};
layout(std430, binding = 11) readonly buffer Tiles { Tile tiles[]; };

layout(location = 0) out vec2 at;  // from the middle, in lengths of the tile [m]
layout(location = 1) out vec3 world;
layout(location = 2) flat out uint index;
out gl_PerVertex { vec4 gl_Position; };

void main() {
  index = uint(gl_VertexID) / 6u;
  int vertex = gl_VertexID % 6;
  vec2 corner = 2.0 * vec2(vertex == 1 || vertex == 3 || vertex == 4, vertex == 2 || vertex == 4 || vertex == 5) - 1.0;
  Tile tile = tiles[index];
  at = corner * vec2(length(tile.half_width.xyz), length(tile.half_height.xyz));
  world = tile.center.xyz + corner.x * tile.half_width.xyz + corner.y * tile.half_height.xyz;
  gl_Position = frame.view_projection * vec4(world, 1.0);
  gl_Position.z = 0.0;  // far away: bodies that swim through a tile stay visible
}
