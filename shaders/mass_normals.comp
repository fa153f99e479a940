// The normal of a smooth skin at each mass: the mean of its faces', weighted by their areas.
#include "bodies.glsl"
layout(local_size_x = 64) in;
layout(std430, binding = 5) readonly buffer FaceFrames { FaceFrame face_frames[]; };
layout(std430, binding = 8) writeonly buffer MassNormals { vec4 mass_normals[]; };
layout(std430, binding = 11) readonly buffer MassFaceEnds { uint mass_face_ends[]; };
layout(std430, binding = 12) readonly buffer MassFaces { uint mass_faces[]; };
layout(location = 0) uniform uint count;

void main() {
  uint mass = gl_GlobalInvocationID.x + gl_GlobalInvocationID.y * gl_NumWorkGroups.x * gl_WorkGroupSize.x;
  if (mass >= count) return;
  vec3 sum = vec3(0.0);
  for (uint i = mass == 0u ? 0u : mass_face_ends[mass - 1u]; i < mass_face_ends[mass]; ++i) {
    vec4 normal = face_frames[mass_faces[i]].normal;
    sum += normal.xyz * normal.w;
  }
  mass_normals[mass] = vec4(sum * inversesqrt(max(dot(sum, sum), 1e-30)), 0.0);
}
