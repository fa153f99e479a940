// SPDX-License-Identifier: Apache-2.0
// How much of the key light reaches the nearest surface in each pixel. Soft shadows are too expensive for each of the 4
// samples of a pixel, so this runs once per pixel.
#include "frame.glsl"
#include "bodies.glsl"
#include "shadow.glsl"
#include "cut.glsl"
layout(local_size_x = 8, local_size_y = 8) in;
layout(binding = 0) uniform sampler2D depths;
layout(binding = 12) uniform usampler2D faces;  // of surface.frag
layout(std430, binding = 13) readonly buffer FaceNormals { uint face_normals[]; };
layout(binding = 0, rgba16f) writeonly uniform image2D map;  // visibility, distance, normal (octahedral)

void main() {
  ivec2 texel = ivec2(gl_GlobalInvocationID.xy), size = imageSize(map);
  if (any(greaterThanEqual(texel, size))) return;
  uint face = texelFetch(faces, texel, 0).r;
  if (face == 0u) {
    imageStore(map, texel, vec4(1.0, 6e4, 0.0, 0.0));
    return;
  }
  float range = distance_of_depth(texelFetch(depths, texel, 0).r);
  vec2 uv = (vec2(texel) + 0.5) / vec2(size);
  vec3 sight = transpose(mat3(frame.view)) * vec3((2.0 * uv - 1.0) * frame.depth.zw, -1.0);
  vec3 normal;
  if ((face & CUT_BODY) != 0u)
    normal = placements[face & ~CUT_BODY].cut.xyz;
  else
    normal = normalize(unpacked_direction(face_normals[face - 1u]));
  if (dot(normal, sight) > 0.0) normal = -normal;
  float visibility = 0.0;  // 0 for surfaces that turn away from the light
  if (dot(normal, frame.to_key.xyz) > -0.6)
    visibility = key_visibility(frame.eye.xyz + range * sight, normal, pixel_noise(vec2(texel) + 0.5));
  imageStore(map, texel, vec4(visibility, range, octahedral(normal)));
}
