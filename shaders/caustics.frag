// SPDX-License-Identifier: Apache-2.0
// The light that arrives in this pixel: how much area of the water's surface is focused into it. Blending adds up the
// light of crossing rays.
layout(location = 0) in vec2 source;
layout(location = 0) out float light;
layout(location = 1) uniform float pixels;  // per side of the tile

void main() {
  vec2 dx = dFdx(source), dy = dFdy(source);
  light = min(abs(dx.x * dy.y - dx.y * dy.x) * pixels * pixels, 12.0);
}
