// SPDX-License-Identifier: Apache-2.0
// Edges look rounded because normals are blended; the geometry stays flat. On faces that are too small in the picture for
// it to be seen, nothing is blended, which saves small robots a quarter of the time of their skins.
#include "direction.glsl"
#include "seen_face.glsl"
const float bevel = 0.11;                     // of the shorter side
const vec2 pixels_beveled = vec2(7.0, 11.0);  // faces of this many pixels are not beveled, and wholly

vec3 normal_of(uint bits) { return normalize(unpacked_direction(bits)); }

// The face's normal at a point in the body's coordinates. Toward the edges it is blended with the neighbors', so that both
// sides of an edge agree.
vec3 beveled_normal(SeenFace face, vec3 normal, vec3 local, out float seam) {
  seam = 0.0;
  vec2 shape_and_size = unpackHalf2x16(face.shape_and_size);
  if (shape_and_size.y < pixels_beveled.x) return normal;
  float strength = smoothstep(pixels_beveled.x, pixels_beveled.y, shape_and_size.y);
  vec2 uv = vec2(dot(local, face.along_u.xyz) + face.along_u.w, dot(local, face.along_v.xyz) + face.along_v.w);
  vec2 height = 1.0 / vec2(length(face.along_u.xyz), length(face.along_v.xyz));
  vec4 off;  // distance from the edges of FaceRecord.neighbors [m]
  float size = min(height.x, height.y);
  bool quadrilateral = shape_and_size.x < 3.0;
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
  seam = strength * float(quadrilateral) * clamp(groove / pixel, 0.0, 1.0) *
         (1.0 - smoothstep(0.3 * groove, groove + 1.3 * pixel, nearest));
  vec4 near = strength * (1.0 - smoothstep(0.0, bevel * size, off));
  vec3 sum = normal;
  for (int i = 0; i < 4; ++i) {
    uint around = face.normals_around[i];
    if (near[i] > 0.0 && around != NO_NORMAL) sum += near[i] * normal_of(around);
  }
  return sum;
}
