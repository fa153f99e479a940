// SPDX-License-Identifier: Apache-2.0
// Depth, and the number of the face. CUT: the backs of skins, in place of which the cut's plane shows.
layout(location = 0) out uint face;  // counted from 1; or the body with CUT_BODY (cut.glsl)

#ifdef CUT
#include "frame.glsl"
#include "cut.glsl"
layout(location = 1) in vec3 world;
layout(location = 5) flat in vec4 cut;
layout(location = 6) flat in uint body_index;

void main() {
  face = CUT_BODY | body_index;
  gl_FragDepth = depth_of(point_of_cut(cut, world - frame.eye.xyz));
}
#else
layout(std430, binding = 15) readonly buffer SeenFaces { uint seen_faces[]; };  // the faces that are drawn

void main() { face = seen_faces[gl_PrimitiveID] + 1u; }
#endif
