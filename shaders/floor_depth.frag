// SPDX-License-Identifier: Apache-2.0
// The floor's depth. It is no body's face.
#include "frame.glsl"
layout(location = 0) in vec2 place;
layout(location = 0) out uint face;

void main() {
  face = 0u;
  vec3 sight = transpose(mat3(frame.view)) * vec3((2.0 * place - 1.0) * frame.depth.zw, -1.0);
  float steps = (frame.ground.w - frame.eye.z) / sight.z;
  bool floor_seen = int(frame.water.x) != AROUND_NONE && steps > frame.depth.x && steps < 0.5 * frame.depth.y;
  gl_FragDepth = floor_seen ? frame.depth.x * (frame.depth.y / steps - 1.0) / (frame.depth.y - frame.depth.x) : 0.0;
}
