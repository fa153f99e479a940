// SPDX-License-Identifier: Apache-2.0
// Edges look rounded because normals are blended; the geometry stays flat.
#include "direction.glsl"
#include "seen_face.glsl"
const float bevel = 0.11;  // of the shorter side

vec3 normal_of(uint bits) { return normalize(unpacked_direction(bits)); }

// The face's normal at a point in the body's coordinates. Towards the edges it is blended with the neighbors', so that both
// sides of an edge agree.
vec3 beveled_normal(SeenFace face, vec3 normal, vec3 local, out float seam) {
  vec2 uv = vec2(dot(local, face.along_u.xyz) + face.along_u.w, dot(local, face.along_v.xyz) + face.along_v.w);
  vec2 height = 1.0 / vec2(length(face.along_u.xyz), length(face.along_v.xyz));
  vec4 off;  // distance from the edges of FaceRecord.neighbors [m]
  float size = min(height.x, height.y);
  bool quadrilateral = face.shape < 3u;
  if (quadrilateral) {
    off = vec4(uv.x * height.x, (1.0 - uv.x) * height.x, uv.y * height.y, (1.0 - uv.y) * height.y);
  } else {
    float third = 1.0 / length(face.along_u.xyz + face.along_v.xyz);
    size = 0.6 * min(size, third);
    off = vec4((1.0 - uv.x - uv.y) * third, uv * height, 1e9);
  }
  // A fine groove between voxels shows how a flat side is stretched. It fades out before it is thinner than a pixel.
  float nearest = min(min(off.x, off.y), min(off.z, off.w));
  float pixel = fwidth(nearest) + 1e-6 * size;
  float groove = 0.022 * size;
  seam = float(quadrilateral) * clamp(groove / pixel, 0.0, 1.0) * (1.0 - smoothstep(0.3 * groove, groove + 1.3 * pixel, nearest));
  vec4 near = 1.0 - smoothstep(0.0, bevel * size, off);
  vec3 sum = normal;
  for (int i = 0; i < 4; ++i) {
    uint around = face.normals_around[i];
    if (near[i] > 0.0 && around != NO_NORMAL) sum += near[i] * normal_of(around);
  }
  return sum;
}
