// SPDX-License-Identifier: Apache-2.0
// Depth, and which face it is of. CUT: of a skin's back, which stands for what a cut lays open.
layout(location = 0) out uint face;  // counted from 1; the largest is the cut

#ifdef CUT
#include "frame.glsl"
#include "cut.glsl"
layout(location = 1) in vec3 world;

void main() {
  face = 0xffffffffu;
  gl_FragDepth = depth_of(point_of_cut(world - frame.eye.xyz));
}
#else
layout(std430, binding = 15) readonly buffer SeenFaces { uint seen_faces[]; };  // that are drawn

void main() { face = seen_faces[gl_PrimitiveID] + 1u; }
#endif
