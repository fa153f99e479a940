// SPDX-License-Identifier: Apache-2.0
// The normal and area of each face, from the positions.
#include "bodies.glsl"
layout(local_size_x = 64) in;
layout(std430, binding = 13) writeonly buffer FaceNormals { uint face_normals[]; };
layout(std430, binding = 14) writeonly buffer FaceAreas { float face_areas[]; };
layout(std430, binding = 7) readonly buffer Faces { uint faces[]; };
layout(location = 0) uniform uint count;

void main() {
  uint face = gl_GlobalInvocationID.x + gl_GlobalInvocationID.y * gl_NumWorkGroups.x * gl_WorkGroupSize.x;
  if (face >= count) return;
  vec3 a = position_of(faces[3u * face]);
  vec3 twice_area = cross(position_of(faces[3u * face + 1u]) - a, position_of(faces[3u * face + 2u]) - a);
  float squared = max(dot(twice_area, twice_area), 1e-20);
  face_normals[face] = packed_direction(twice_area * inversesqrt(squared));
  face_areas[face] = 0.5 * sqrt(squared);
}
