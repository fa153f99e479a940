// SPDX-License-Identifier: Apache-2.0
// A particle or bubble (render/particles.h): a strip of 6 vertices, longer in fast flow.
#include "frame.glsl"
#include "ribbon.glsl"
struct Particle {
  vec4 ball;  // center, radius [m]
  vec4 flow;  // [m/s]; w = 1 for a bubble
};
layout(std430, binding = 11) readonly buffer Particles { Particle particles[]; };
layout(location = 0) uniform vec4 box;    // center and half side of the cube of particles [m]
layout(location = 1) uniform vec2 share;  // exposure time, which sets the length [s]; opacity of this set of particles

layout(location = 0) out vec2 on_strip;
layout(location = 1) flat out float opacity;
layout(location = 2) flat out float slenderness;
layout(location = 3) flat out float hollow;  // 1 = a bubble that is large enough in the picture
out gl_PerVertex { vec4 gl_Position; };

void main() {
  Particle particle = particles[gl_VertexID / 6];
  vec2 corner = ribbon_corner(gl_VertexID % 6);
  vec3 center = particle.ball.xyz;
  vec3 streak = particle.flow.xyz * share.x * (1.0 - particle.flow.w);
  vec3 to_eye = normalize(frame.eye.xyz - center);
  streak -= to_eye * dot(streak, to_eye);
  float pixel = pixel_size(center);
  float radius = particle.ball.w;
  float shown = max(radius, 0.9 * pixel);
  vec3 axis = length(streak) > 1e-6 ? normalize(streak) : across_of(vec3(0.0, 0.0, 1.0), to_eye);
  vec3 side = across_of(axis, to_eye);
  float reach = shown + 0.5 * length(streak);
  slenderness = shown / reach;
  hollow = particle.flow.w * smoothstep(1.5, 3.0, radius / pixel);
  on_strip = vec2(2.0 * corner.x - 1.0, corner.y);
  vec3 world = center + axis * on_strip.x * reach + side * on_strip.y * shown;
  vec3 off = abs(center - box.xyz) / box.w;
  float inside = 1.0 - smoothstep(0.75, 1.0, max(off.x, max(off.y, off.z)));
  float range = distance(center, frame.eye.xyz);
  float nearness = smoothstep(0.45, 0.95, range / frame.water.w);
  opacity = inside * nearness * (radius * radius) / (shown * shown) * sqrt(slenderness) * exp(-0.5 * range / frame.water.w);
  opacity *= share.y * step(frame.ground.w, center.z);
  gl_Position = frame.view_projection * vec4(world, 1.0);
}
