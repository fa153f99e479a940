// SPDX-License-Identifier: Apache-2.0
// A corner of a skin, with the SeenFace of its face.
#include "frame.glsl"
#include "direction.glsl"
#include "seen_face.glsl"
#include "skins.glsl"
layout(location = 0) in uint corner;  // 3 times the face, plus 0 to 2

flat out vec4 along_u;
flat out vec4 along_v;
flat out uvec4 normals_around;
flat out uvec2 normal_and_shape;
flat out vec4 material;
out vec3 world;
out vec4 smooth_normal;  // w = 0: the skin has edges
out float value;

void main() {
  uint index = corner / 3u;
  uvec4 face = texelFetch(faces, texel_of(2u * index), 0), around = texelFetch(faces, texel_of(2u * index + 1u), 0);
  uint first = shape_of(face) > 2u ? 0u : shape_of(face);
  vec3 a = mass_at(face[first]).xyz;
  vec3 u = mass_at(face[(first + 1u) % 3u]).xyz - a, v = mass_at(face[(first + 2u) % 3u]).xyz - a;
  vec3 twice_area = cross(u, v);
  float squared = max(dot(twice_area, twice_area), 1e-20);
  // The dual basis of u, v in their plane.
  along_u.xyz = cross(v, twice_area) / squared;
  along_v.xyz = cross(twice_area, u) / squared;
  along_u.w = -dot(along_u.xyz, a);
  along_v.w = -dot(along_v.xyz, a);
  normals_around = uvec4(packed_normal_of(around.x), packed_normal_of(around.y), packed_normal_of(around.z),
                         packed_normal_of(around.w));
  normal_and_shape = uvec2(packed_direction(twice_area * inversesqrt(squared)), shape_of(face));
  material = texelFetch(materials, texel_of(material_of(face)), 0);
  uint own = face[corner % 3u];
  vec4 mass = mass_at(own);
  world = mass.xyz;
  value = mass.w;
  smooth_normal = is_smooth(face) ? vec4(texelFetch(mass_normals, texel_of(own), 0).xyz, 1.0) : vec4(0.0);
  gl_Position = frame.view_projection * vec4(world, 1.0);
}
