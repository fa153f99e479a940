// SPDX-License-Identifier: Apache-2.0
// Depth, and the number of the face. CUT: the backs of skins, in place of which the cut's plane shows.
layout(location = 0) out uint face;  // counted from 1; the largest number is the cut

#ifdef CUT
#include "frame.glsl"
#include "cut.glsl"
layout(location = 1) in vec3 world;

void main() {
  face = 0xffffffffu;
  gl_FragDepth = depth_of(point_of_cut(world - frame.eye.xyz));
}
#else
layout(std430, binding = 15) readonly buffer SeenFaces { uint seen_faces[]; };  // the faces that are drawn

void main() { face = seen_faces[gl_PrimitiveID] + 1u; }
#endif
