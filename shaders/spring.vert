// SPDX-License-Identifier: Apache-2.0
// A spring as a strip of 6 vertices that faces the eye or, with SHADOW, the key light.
#include "frame.glsl"
#include "bodies.glsl"
#include "values.glsl"
#include "ribbon.glsl"
layout(std430, binding = 10) readonly buffer MassValues { float mass_values[]; };
layout(std430, binding = 11) readonly buffer Springs { uint springs[]; };
layout(std430, binding = 12) readonly buffer SpringMaterials { uint spring_materials[]; };
layout(std430, binding = 13) readonly buffer SpringValues { float spring_values[]; };

layout(location = 0) uniform float radius;      // [m]
layout(location = 1) uniform int color_by;      // 0 materials, 1 mass values, 2 spring values
layout(location = 2) uniform vec4 value_scale;
layout(location = 3) uniform uint first;        // springs of earlier calls
layout(binding = 7) uniform sampler2D colormap;

layout(location = 0) out vec3 world;
layout(location = 1) out float across;
layout(location = 2) flat out vec3 side;
layout(location = 3) flat out vec3 axis;
layout(location = 4) out vec4 material;  // color, activation
layout(location = 5) flat out uint flags;

out gl_PerVertex {
  vec4 gl_Position;
  float gl_ClipDistance[1];
};

vec4 material_of(uint spring, uint mass, uint placement_flags) {
  if (color_by == 0) return material_at(spring_materials[spring], placement_flags);
  float value = color_by == 1 ? mass_values[mass] : spring_values[spring];
  return vec4(textureLod(colormap, on_colormap(value, value_scale), 0.0).rgb, 0.0);
}

void main() {
  uint spring = first + uint(gl_VertexID) / 6u;
  vec2 corner = ribbon_corner(gl_VertexID % 6);
  uint mass_a = springs[2u * spring], mass_b = springs[2u * spring + 1u];
  Placement placement = placements[mass_bodies[mass_a]];
  vec3 a = position_of(mass_a) + placement.offset, b = position_of(mass_b) + placement.offset;
  vec3 point = mix(a, b, corner.x);
#ifdef SHADOW
  vec3 to_eye = frame.to_key.xyz;
  float thickness = radius;
#else
  vec3 to_eye = frame.eye.xyz - point;
  float thickness = max(radius, 0.6 * pixel_size(point));
#endif
  material = material_of(spring, corner.x < 0.5 ? mass_a : mass_b, placement.flags);
  axis = normalize(b - a);
  side = across_of(axis, to_eye);
  across = corner.y;
  // A muscle swells as it shortens.
  world = point + side * corner.y * thickness * (1.0 + 0.25 * material.a);
  flags = placement.flags;
#ifdef SHADOW
  vec3 on_map = (frame.shadow * vec4(world, 1.0)).xyz;
  gl_Position = vec4(2.0 * on_map.xy - 1.0, on_map.z, 1.0);
#else
  gl_Position = frame.view_projection * vec4(world, 1.0);
#endif
  if ((flags & PLACEMENT_HIDDEN) != 0u) gl_Position = vec4(2.0, 2.0, 2.0, 1.0);
  gl_ClipDistance[0] = placement.cut.w - dot(placement.cut.xyz, world);
}
