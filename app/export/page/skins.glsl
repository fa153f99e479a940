// SPDX-License-Identifier: Apache-2.0
// The bodies in textures that are read by index. bodies.js writes them.
uniform usampler2D faces;  // two texels per face: masses, bits; the neighbors of FaceRecord (render/body_data.h)
uniform sampler2D masses;  // position in the picture [m]; value to color by, 0 to 1
uniform sampler2D face_normals;
uniform sampler2D mass_normals;  // of smooth skins
uniform sampler2D materials;     // linear color, activation

#define NO_FACE 0xffffffffu

ivec2 texel_of(uint i) { return ivec2(i & 1023u, i >> 10u); }

// Of bits: shape as in FaceRecord, whether the skin is smooth, and the material.
uint shape_of(uvec4 face) { return face.w & 3u; }
bool is_smooth(uvec4 face) { return (face.w & 4u) != 0u; }
uint material_of(uvec4 face) { return face.w >> 3u; }

vec4 mass_at(uint i) { return texelFetch(masses, texel_of(i), 0); }
uint packed_normal_of(uint face) {
  return face == NO_FACE ? NO_NORMAL : packed_direction(texelFetch(face_normals, texel_of(face), 0).xyz);
}
