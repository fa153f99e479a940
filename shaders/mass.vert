// SPDX-License-Identifier: Apache-2.0
// A mass as a square of 6 vertices around its ball.
#include "frame.glsl"
#include "bodies.glsl"
#include "values.glsl"
#include "ribbon.glsl"
layout(std430, binding = 10) readonly buffer MassValues { float mass_values[]; };
layout(location = 0) uniform float radius;      // [m]
layout(location = 1) uniform int color_by;      // 0 plain, 1 mass values
layout(location = 2) uniform vec4 value_scale;
layout(binding = 7) uniform sampler2D colormap;

layout(location = 0) out vec2 on_ball;  // -1 to 1 over the ball
layout(location = 1) flat out vec3 center;
layout(location = 2) flat out vec3 albedo;
layout(location = 3) flat out float ball_radius;

out gl_PerVertex {
  vec4 gl_Position;
  float gl_ClipDistance[1];
};

void main() {
  uint mass = uint(gl_VertexID) / 6u;
  vec2 corner = ribbon_corner(gl_VertexID % 6);
  Placement placement = placements[mass_bodies[mass]];
  center = position_of(mass) + placement.offset;
  ball_radius = radius;
#ifdef SHADOW
  vec3 to_eye = frame.to_key.xyz;
#else
  ball_radius = max(radius, 1.2 * pixel_size(center));
  vec3 to_eye = normalize(frame.eye.xyz - center);
#endif
  vec3 right = normalize(cross(abs(to_eye.z) > 0.99 ? vec3(1.0, 0.0, 0.0) : vec3(0.0, 0.0, 1.0), to_eye));
  vec3 up = cross(to_eye, right);
  on_ball = vec2(2.0 * corner.x - 1.0, corner.y) * 1.08;
  vec3 world = center + ball_radius * (right * on_ball.x + up * on_ball.y);
  albedo = color_by == 1 ? textureLod(colormap, on_colormap(mass_values[mass], value_scale), 0.0).rgb
                         : vec3(0.62, 0.66, 0.70);
  if ((placement.flags & PLACEMENT_FAULTY) != 0u) albedo = vec3(0.8, 0.08, 0.05);
#ifdef SHADOW
  vec3 on_map = (frame.shadow * vec4(world, 1.0)).xyz;
  gl_Position = vec4(2.0 * on_map.xy - 1.0, on_map.z, 1.0);
#else
  gl_Position = frame.view_projection * vec4(world, 1.0);
#endif
  if ((placement.flags & PLACEMENT_HIDDEN) != 0u) gl_Position = vec4(2.0, 2.0, 2.0, 1.0);
  gl_ClipDistance[0] = placement.cut.w - dot(placement.cut.xyz, center);
}
