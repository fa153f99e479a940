// SPDX-License-Identifier: Apache-2.0
// The normal of a smooth skin at each mass, and its color and activation: the mean over its faces, weighted by area.
#include "bodies.glsl"
layout(local_size_x = 64) in;
layout(std430, binding = 13) readonly buffer FaceNormals { uint face_normals[]; };
layout(std430, binding = 14) readonly buffer FaceAreas { float face_areas[]; };
layout(std430, binding = 8) writeonly buffer MassNormals { vec4 mass_normals[]; };  // two per mass
layout(std430, binding = 11) readonly buffer MassFaceEnds { uint mass_face_ends[]; };
layout(std430, binding = 12) readonly buffer MassFaces { uint mass_faces[]; };
layout(location = 0) uniform uint count;

void main() {
  uint mass = gl_GlobalInvocationID.x + gl_GlobalInvocationID.y * gl_NumWorkGroups.x * gl_WorkGroupSize.x;
  if (mass >= count) return;
  uint flags = placements[mass_bodies[mass]].flags;
  vec3 sum = vec3(0.0);
  vec4 material = vec4(0.0);
  float area = 1e-20;
  for (uint i = mass == 0u ? 0u : mass_face_ends[mass - 1u]; i < mass_face_ends[mass]; ++i) {
    uint face = mass_faces[i];
    sum += normalize(unpacked_direction(face_normals[face])) * face_areas[face];
    material += material_at(face_records[face].material, flags) * face_areas[face];
    area += face_areas[face];
  }
  mass_normals[2u * mass] = vec4(sum * inversesqrt(max(dot(sum, sum), 1e-30)), 0.0);
  mass_normals[2u * mass + 1u] = material / area;
}
