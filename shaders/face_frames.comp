// The frame of each face as its masses stand now.
#include "bodies.glsl"
layout(local_size_x = 64) in;
layout(std430, binding = 5) writeonly buffer FaceFrames { FaceFrame face_frames[]; };
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
  FaceFrame result;
  result.normal = vec4(twice_area * inversesqrt(squared), 0.5 * sqrt(squared));
  result.origin = vec4(a, shape > 2u ? 0.0 : 1.0);
  // The dual basis of u, v in their plane.
  result.along_u = vec4(cross(v, twice_area) / squared, 0.0);
  result.along_v = vec4(cross(twice_area, u) / squared, 0.0);
  face_frames[face] = result;
}
