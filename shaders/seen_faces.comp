// SPDX-License-Identifier: Apache-2.0
// What the pixels of a face need, for each face that is drawn, in the order of drawing: pixels then read one record each
// and need not follow indices.
#include "frame.glsl"
#include "bodies.glsl"
#include "seen_face.glsl"
layout(local_size_x = 64) in;
layout(std430, binding = 5) writeonly buffer SeenFaces { SeenFace seen[]; };
layout(std430, binding = 7) readonly buffer Faces { uint faces[]; };
layout(std430, binding = 12) readonly buffer Commands { uint commands[10]; };  // of cull.comp
layout(std430, binding = 13) readonly buffer FaceNormals { uint face_normals[]; };
layout(std430, binding = 15) readonly buffer FaceNumbers { uint numbers[]; };

layout(location = 0) uniform uint finer;  // bits of a face's number that count the parts of an original face

uint normal_of(uint face) { return face == NO_FACE ? NO_NORMAL : face_normals[face]; }

void main() {
  uint i = gl_GlobalInvocationID.x + gl_GlobalInvocationID.y * gl_NumWorkGroups.x * gl_WorkGroupSize.x;
  if (i >= commands[0] / 3u) return;
  uint face = numbers[i];
  FaceRecord record = face_records[face];
  uint corner = record.shape > 2u ? 0u : record.shape;
  vec3 a = position_of(faces[3u * face + corner]);
  vec3 u = position_of(faces[3u * face + (corner + 1u) % 3u]) - a;
  vec3 v = position_of(faces[3u * face + (corner + 2u) % 3u]) - a;
  vec3 twice_area = cross(u, v);
  float squared = max(dot(twice_area, twice_area), 1e-20);
  // The dual basis of u, v in their plane.
  vec3 along_u = cross(v, twice_area) / squared, along_v = cross(twice_area, u) / squared;
  uvec4 around = record.neighbors;
  float size = 1.0 / sqrt(max(dot(along_u, along_u), dot(along_v, along_v)));
  float range = distance(a + placements[mass_bodies[faces[3u * face]]].offset, frame.eye.xyz);
  float pixels = 0.5 * frame.screen.y / frame.depth.w * size / max(range, 1e-6);
  seen[i] = SeenFace(vec4(along_u, -dot(along_u, a)), vec4(along_v, -dot(along_v, a)),
                     uvec4(normal_of(around.x), normal_of(around.y), normal_of(around.z), normal_of(around.w)),
                     face_normals[face], record.material, packHalf2x16(vec2(float(record.shape), min(pixels, 6e4))),
                     face >> finer);
}
