// SPDX-License-Identifier: Apache-2.0
// Where the inside of a body is seen. A line of sight that crosses the plane of a cut inside of a body leaves it through
// a back, and one that crosses the plane in a gap of a concave body enters through a front next. Behind both there may
// be other backs. So the map has the nearest surface behind the plane (surface.frag), and only where that is a back, the
// plane is drawn. Needs cut.glsl.
layout(binding = 12) uniform usampler2D nearest_surfaces;

bool is_inside(ivec2 at, uint body) {
  ivec2 last = textureSize(nearest_surfaces, 0) - 1;
  return texelFetch(nearest_surfaces, clamp(at, ivec2(0), last), 0).r == (CUT_BODY | body);
}

// `at`: pixel of the map. True beside such pixels too, for the samples of a pixel that an edge crosses.
bool shows_inside(ivec2 at, uint body) {
  return is_inside(at, body) || is_inside(at + ivec2(1, 0), body) || is_inside(at - ivec2(1, 0), body) ||
         is_inside(at + ivec2(0, 1), body) || is_inside(at - ivec2(0, 1), body);
}
