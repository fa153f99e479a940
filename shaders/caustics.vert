// SPDX-License-Identifier: Apache-2.0
// One ray of light per corner of a grid: the waves bend it, and it ends in the tile.
#include "frame.glsl"
layout(location = 0) uniform int cells;  // per side of the grid

layout(location = 0) out vec2 source;  // where the ray met the surface, in tiles
out gl_PerVertex { vec4 gl_Position; };

const int waves = 12;
// Whole numbers of waves per tile, so that tiles join without a seam.
const vec2 vectors[waves] = vec2[](vec2(1, 2), vec2(2, -1), vec2(-2, 2), vec2(3, 1), vec2(-1, -3), vec2(3, -3),
                                   vec2(-4, 1), vec2(2, 4), vec2(4, 3), vec2(-3, 5), vec2(-5, -3), vec2(6, -2));

void main() {
  // The grid is larger than the tile, by the distance that rays are bent.
  const float beyond = 0.2;
  vec2 corner = vec2(gl_VertexID % (cells + 1), gl_VertexID / (cells + 1)) / float(cells);
  source = corner * (1.0 + 2.0 * beyond) - beyond;
  vec2 bent = source;
  for (int i = 0; i < waves; ++i) {
    float size = length(vectors[i]);
    float speed = 1.3 * sqrt(size);  // deep water: short waves are slower than long ones but pass more often
    float phase = 6.2831853 * dot(vectors[i], source) - speed * frame.eye.w + 1.7 * float(i * i);
    bent += 0.092 * vectors[i] / size * cos(phase) / pow(size, 1.35);
  }
  gl_Position = vec4(2.0 * bent - 1.0, 0.0, 1.0);
}
