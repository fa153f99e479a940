// SPDX-License-Identifier: Apache-2.0
// How much light reaches the nearest surface in each pixel. Soft shadows, caustics and occlusion are too expensive for
// each of the 4 samples of a pixel, so this runs once per pixel.
#include "frame.glsl"
#include "bodies.glsl"
#include "shadow.glsl"
#define CAUSTICS_IN_COMPUTE
#include "caustics.glsl"
#include "occlusion.glsl"
#include "cut.glsl"
layout(local_size_x = 8, local_size_y = 8) in;
layout(binding = 0) uniform sampler2D depths;
layout(binding = 12) uniform usampler2D faces;  // of surface.frag
layout(std430, binding = 13) readonly buffer FaceNormals { uint face_normals[]; };
// Halves: key light, share of ambient light; distance; then bytes: normal (octahedral).
layout(binding = 0, rg32ui) writeonly uniform uimage2D map;

void store(ivec2 texel, vec2 light, float range, vec3 normal) {
  uint where = (packHalf2x16(vec2(range, 0.0)) & 0xffffu) | packSnorm4x8(vec4(0.0, 0.0, octahedral(normal)));
  imageStore(map, texel, uvec4(packHalf2x16(light), where, 0u, 0u));
}

// Rotates the pattern of samples in five steps, so that a pixel and its four neighbors have all five:
//   0 1 2 3 4
//   2 3 4 0 1      front_light.glsl takes their mean, in which the patterns together have no speckles.
//   4 0 1 2 3
float rotation(ivec2 texel) { return fract(frame.lens.z + (float((texel.x + 2 * texel.y) % 5) + 0.5) / 5.0); }

// The point of a plane that is seen through a place of the picture. `plane`: normal and offset, relative to the eye.
vec3 seen_point(vec4 plane, vec2 uv) {
  vec3 sight = sight_through(uv);
  return frame.eye.xyz + sight * (plane.w / min(dot(plane.xyz, sight), -1e-3));
}

void main() {
  ivec2 texel = ivec2(gl_GlobalInvocationID.xy), size = imageSize(map);
  if (any(greaterThanEqual(texel, size))) return;
  uint face = texelFetch(faces, texel, 0).r;
  if (face == 0u) {
    store(texel, vec2(1.0), 6e4, vec3(0.0, 0.0, 1.0));
    return;
  }
  float range = distance_of_depth(texelFetch(depths, texel, 0).r);
  vec2 uv = (vec2(texel) + 0.5) / vec2(size);
  vec3 sight = sight_through(uv);
  vec3 normal;
  if ((face & CUT_BODY) != 0u)
    normal = placements[face & ~CUT_BODY].cut.xyz;
  else
    normal = normalize(unpacked_direction(face_normals[face - 1u]));
  if (dot(normal, sight) > 0.0) normal = -normal;
  float key = 0.0;  // for surfaces that turn away from the light
  if (dot(normal, frame.to_key.xyz) > -0.6) {
    vec3 point = frame.eye.xyz + range * sight;
    key = key_visibility(point, normal, rotation(texel));
#if AROUND == AROUND_WATER
    vec4 plane = vec4(normal, range * dot(normal, sight));
    vec2 at = surface_point(point);
    float across = distance(surface_point(seen_point(plane, uv + vec2(frame.screen.z, 0.0))), at);
    float along = distance(surface_point(seen_point(plane, uv + vec2(0.0, frame.screen.w))), at);
    key *= caustics_on_skin(at, max(across, along));
#endif
  }
  store(texel, vec2(key, openness(vec2(texel) + 0.5, range)), range, normal);
}
