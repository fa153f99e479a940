// SPDX-License-Identifier: Apache-2.0
// One triangle that covers the picture, at the farthest depth. NEAR_PART, FAR_PART: only the part of it in which the floor is
// seen, or the rest and two rows of pixels of the floor.
layout(location = 0) out vec2 uv;  // 0 to 1
#if defined(NEAR_PART) || defined(FAR_PART)
#include "frame.glsl"
out gl_PerVertex {
  vec4 gl_Position;
  float gl_ClipDistance[1];
};
#else
out gl_PerVertex { vec4 gl_Position; };
#endif

void main() {
  uv = vec2(gl_VertexID == 1 ? 2.0 : 0.0, gl_VertexID == 2 ? 2.0 : 0.0);
  gl_Position = vec4(2.0 * uv - 1.0, 0.0, 1.0);
#if defined(NEAR_PART) || defined(FAR_PART)
  // The floor is seen where it is less than half as far as the farthest depth.
  float to_floor = frame.ground.w - frame.eye.z;
  float inside = sight_through(uv).z * sign(to_floor) - abs(to_floor) / (0.5 * frame.depth.y);
#ifdef NEAR_PART
  gl_ClipDistance[0] = inside;
#else
  gl_ClipDistance[0] = 4.0 * frame.screen.w * frame.depth.w - inside;
#endif
#endif
}
