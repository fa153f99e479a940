// SPDX-License-Identifier: Apache-2.0
// A spring near the cut: a triangle in the cut's plane that holds the circle in which the spring counts.
#include "frame.glsl"
#include "bodies.glsl"
#include "values.glsl"
layout(std430, binding = 10) readonly buffer MassValues { float mass_values[]; };
layout(std430, binding = 11) readonly buffer Springs { uint springs[]; };
layout(std430, binding = 12) readonly buffer SpringMaterials { uint spring_materials[]; };
layout(location = 0) uniform float reach;       // [m]
layout(location = 1) uniform int color_by;      // 0 materials, 1 mass values, 2 gray, for values of faces
layout(location = 2) uniform vec4 value_scale;
layout(location = 3) uniform uint first;        // springs of earlier calls
layout(binding = 7) uniform sampler2D colormap;

layout(location = 0) out vec3 offset;  // from the spring's middle
layout(location = 1) flat out vec4 material;  // color, activation
layout(location = 2) flat out uint body;
out gl_PerVertex { vec4 gl_Position; };

vec4 material_of(uint spring, uint a, uint b, uint flags) {
  if (color_by == 0) return material_at(spring_materials[spring], flags);
  if (color_by == 2) return vec4(0.35, 0.35, 0.35, 0.0);
  float value = 0.5 * (mass_values[a] + mass_values[b]);
  return vec4(textureLod(colormap, on_colormap(value, value_scale), 0.0).rgb, 0.0);
}

void main() {
  uint spring = first + uint(gl_VertexID) / 3u;
  int third = gl_VertexID % 3;
  vec2 corner = third == 2 ? vec2(0.0, 2.0) : vec2(third == 0 ? -sqrt(3.0) : sqrt(3.0), -1.0);
  uint a = springs[2u * spring], b = springs[2u * spring + 1u];
  body = mass_bodies[a];
  Placement placement = placements[body];
  vec3 middle = 0.5 * (position_of(a) + position_of(b)) + placement.offset;
  vec3 normal = placement.cut.xyz;
  float height = dot(normal, middle) - placement.cut.w;
  vec3 across = normalize(cross(abs(normal.z) > 0.9 ? vec3(1.0, 0.0, 0.0) : vec3(0.0, 0.0, 1.0), normal));
  float radius = sqrt(max(0.0, reach * reach - height * height));
  offset = radius * (corner.x * across + corner.y * cross(normal, across)) - height * normal;
  material = material_of(spring, a, b, placement.flags);
  gl_Position = frame.view_projection * vec4(middle + offset, 1.0);
  bool seen = dot(normal, frame.eye.xyz) > placement.cut.w;
  if (!seen || abs(height) > reach || (placement.flags & PLACEMENT_HIDDEN) != 0u) gl_Position = vec4(2.0, 2.0, 2.0, 1.0);
}
