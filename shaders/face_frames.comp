// SPDX-License-Identifier: Apache-2.0
// The FaceFrame, normal and area of each face, from the positions.
#include "bodies.glsl"
layout(local_size_x = 64) in;
layout(std430, binding = 5) writeonly buffer FaceFrames { FaceFrame face_frames[]; };
layout(std430, binding = 13) writeonly buffer FaceNormals { uint face_normals[]; };
layout(std430, binding = 14) writeonly buffer FaceAreas { float face_areas[]; };
layout(std430, binding = 7) readonly buffer Faces { uint faces[]; };
layout(location = 0) uniform uint count;

void main() {
  uint face = gl_GlobalInvocationID.x + gl_GlobalInvocationID.y * gl_NumWorkGroups.x * gl_WorkGroupSize.x;
  if (face >= count) return;
  uint shape = face_records[face].shape;
  uint corner = shape > 2u ? 0u : shape;
  vec3 a = position_of(faces[3u * face + corner]);
  vec3 u = position_of(faces[3u * face + (corner + 1u) % 3u]) - a;
  vec3 v = position_of(faces[3u * face + (corner + 2u) % 3u]) - a;
  vec3 twice_area = cross(u, v);
  float squared = max(dot(twice_area, twice_area), 1e-20);
  face_normals[face] = packed_direction(twice_area * inversesqrt(squared));
  face_areas[face] = 0.5 * sqrt(squared);
  // The dual basis of u, v in their plane.
  vec3 along_u = cross(v, twice_area) / squared, along_v = cross(twice_area, u) / squared;
  face_frames[face] = FaceFrame(vec4(along_u, -dot(along_u, a)), vec4(along_v, -dot(along_v, a)));
}
