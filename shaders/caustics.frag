// SPDX-License-Identifier: Apache-2.0
// Light that arrives here: how much of the surface's area is squeezed into this pixel. Added up where rays cross.
layout(location = 0) in vec2 source;
layout(location = 0) out float light;
layout(location = 1) uniform float pixels;  // of the tile along a side

void main() {
  vec2 dx = dFdx(source), dy = dFdy(source);
  light = min(abs(dx.x * dy.y - dx.y * dy.x) * pixels * pixels, 12.0);
}
