// SPDX-License-Identifier: Apache-2.0
// Depth, and the number of the face.
// CUT           the backs of skins, in place of which the cut's plane shows
// BACKS         the same, where they are
layout(location = 0) out uint face;  // counted from 1; or the body with CUT_BODY (cut.glsl)

#ifdef CUT
#include "frame.glsl"
#include "cut.glsl"
#ifndef BACKS
#include "cut_map.glsl"
#endif
layout(location = 1) in vec3 world;
layout(location = 5) flat in vec4 cut;
layout(location = 6) flat in uint body_index;

void main() {
  face = CUT_BODY | body_index;
#ifndef BACKS
  // This picture may be smaller than the map.
  vec4 clip = frame.view_projection * vec4(world, 1.0);
  vec2 uv = 0.5 + 0.5 * clip.xy / clip.w;
  if (!shows_inside(ivec2(uv * vec2(textureSize(nearest_surfaces, 0))), body_index)) discard;
  gl_FragDepth = depth_of(point_of_cut(cut, world - frame.eye.xyz));
#endif
}
#else
layout(std430, binding = 15) readonly buffer SeenFaces { uint seen_faces[]; };  // the faces that are drawn

void main() { face = seen_faces[gl_PrimitiveID] + 1u; }
#endif
