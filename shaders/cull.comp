// SPDX-License-Identifier: Apache-2.0
// Lists of the faces that turn toward the eye and toward the key light; render/passes/visibility_passes.h explains the stages.
// STAGE 0 counts the faces in groups of 256, 1 sums the counts, 2 writes the lists.
#include "frame.glsl"
#include "bodies.glsl"
layout(local_size_x = 256) in;
layout(std430, binding = 7) readonly buffer Faces { uint faces[]; };
layout(std430, binding = 11) buffer Counts { uvec2 counts[]; };  // per group: its faces; after stage 1: faces in earlier groups
layout(std430, binding = 12) writeonly buffer Commands { uint commands[10]; };  // DrawElementsIndirectCommand, twice
layout(std430, binding = 13) writeonly buffer SeenCorners { uint seen_corners[]; };
layout(std430, binding = 14) writeonly buffer LitCorners { uint lit_corners[]; };
layout(std430, binding = 15) writeonly buffer SeenFaces { uint seen_faces[]; };
layout(location = 0) uniform uint count;
layout(location = 1) uniform uint groups;
layout(location = 2) uniform bool all_sides;  // lists also faces that turn away

shared uvec2 sums[256];

// The sum over all lanes up to this one.
uvec2 running_sum(uvec2 own) {
  uint lane = gl_LocalInvocationID.x;
  sums[lane] = own;
  for (uint step = 1u; step < 256u; step *= 2u) {
    barrier();
    uvec2 before = lane >= step ? sums[lane - step] : uvec2(0u);
    barrier();
    sums[lane] += before;
  }
  barrier();
  return sums[lane];
}

#if STAGE == 1
void main() {
  uint lane = gl_LocalInvocationID.x;
  uint share = (groups + 255u) / 256u;
  uint first = min(lane * share, groups), last = min(first + share, groups);
  uvec2 own = uvec2(0u);
  for (uint group = first; group < last; ++group) own += counts[group];
  uvec2 before = running_sum(own) - own;
  for (uint group = first; group < last; ++group) {
    uvec2 here = counts[group];
    counts[group] = before;
    before += here;
  }
  if (lane != 255u) return;
  for (uint i = 0u; i < 10u; ++i) commands[i] = 0u;
  commands[0] = 3u * before.x;
  commands[5] = 3u * before.y;
  commands[1] = 1u;
  commands[6] = 1u;
}
#else
void main() {
  uint group = gl_WorkGroupID.x + gl_WorkGroupID.y * gl_NumWorkGroups.x;
  uint face = 256u * group + gl_LocalInvocationID.x;
  uvec2 turned = uvec2(0u);
  uvec3 corners = uvec3(0u);
  if (face < count) {
    corners = uvec3(faces[3u * face], faces[3u * face + 1u], faces[3u * face + 2u]);
    Placement placement = placements[mass_bodies[corners.x]];
    vec3 a = position_of(corners.x), u = position_of(corners.y) - a, v = position_of(corners.z) - a;
    vec3 normal = cross(u, v), from_eye = a + placement.offset - frame.eye.xyz;
    // Keeps faces that are nearly edge-on: the rasterizer decides about those.
    float margin = 1e-4 * length(normal);
    bool shown = (placement.flags & PLACEMENT_HIDDEN) == 0u;
    turned.x = uint(shown && (all_sides || dot(normal, from_eye) < margin * length(from_eye)));
    turned.y = uint(shown && (all_sides || dot(normal, frame.to_key.xyz) > -margin));
  }
  uvec2 index = running_sum(turned);
#if STAGE == 0
  if (gl_LocalInvocationID.x == 255u && group < groups) counts[group] = index;
#else
  if (face >= count) return;
  index += counts[group] - turned;
  if (turned.x != 0u) {
    seen_faces[index.x] = face;
    for (uint i = 0u; i < 3u; ++i) seen_corners[3u * index.x + i] = corners[i];
  }
  if (turned.y != 0u)
    for (uint i = 0u; i < 3u; ++i) lit_corners[3u * index.y + i] = corners[i];
#endif
}
#endif
