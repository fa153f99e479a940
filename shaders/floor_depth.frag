// SPDX-License-Identifier: Apache-2.0
// The floor's depth. Face number 0 means that it is not a face of a body.
#include "frame.glsl"
layout(location = 0) in vec2 uv;
layout(location = 0) out uint face;

void main() {
  face = 0u;
  vec3 sight = sight_through(uv);
  float steps = (frame.ground.w - frame.eye.z) / sight.z;
  bool has_floor = int(frame.water.x) != AROUND_NONE || frame.octave.w > 0.5;  // or one that catches shadows alone
  bool hits_floor = has_floor && steps > frame.depth.x && steps < 0.5 * frame.depth.y;
  gl_FragDepth = hits_floor ? frame.depth.x * (frame.depth.y / steps - 1.0) / (frame.depth.y - frame.depth.x) : 0.0;
}
