// SPDX-License-Identifier: Apache-2.0
// A particle that drifts with the water: a strip of 6 vertices, longer in fast flow. The program's particles follow
// robots, by buffers that WebGL does not have.
#include "frame.glsl"
#include "ribbon.glsl"
layout(location = 0) uniform vec4 box;   // center and half side of the cube of particles [m]
layout(location = 1) uniform vec4 flow;  // [m/s]; w = exposure time, which sets the length [s]
layout(location = 3) uniform float share;  // opacity of this set of particles
layout(location = 2) uniform vec3 drift; // flow times time, taken modulo the box's side in double precision [m]

layout(location = 0) out vec2 on_strip;
layout(location = 1) flat out float opacity;
layout(location = 2) flat out float slenderness;
layout(location = 3) flat out float hollow;
out gl_PerVertex { vec4 gl_Position; };

float hash(uint n) {
  n = (n ^ 61u) ^ (n >> 16u);
  n *= 9u;
  n ^= n >> 4u;
  n *= 0x27d4eb2du;
  return float((n ^ (n >> 15u)) & 0xffffffu) / 16777216.0;
}

void main() {
  uint particle = uint(gl_VertexID) / 6u;
  vec2 corner = ribbon_corner(gl_VertexID % 6);
  vec3 home = vec3(hash(3u * particle), hash(3u * particle + 1u), hash(3u * particle + 2u)) * 2.0 * box.w;
  float t = frame.eye.w * (0.15 + 0.2 * hash(7u * particle + 11u));
  vec3 wander = 0.03 * box.w * vec3(sin(t + home.x * 3.0), sin(1.3 * t + home.y * 2.0), cos(0.9 * t + home.z * 3.0));
  // Positions wrap around the center of the box, so particles surround the camera wherever it goes.
  vec3 center = mod(home + wander + drift - box.xyz + box.w, 2.0 * box.w) - box.w + box.xyz;
  vec3 streak = flow.xyz * flow.w;
  vec3 to_eye = normalize(frame.eye.xyz - center);
  streak -= to_eye * dot(streak, to_eye);
  float pixel = pixel_size(center);
  float radius = box.w * 0.0009 * (0.5 + hash(5u * particle + 3u));
  float shown = max(radius, 0.9 * pixel);
  vec3 axis = length(streak) > 1e-6 ? normalize(streak) : across_of(vec3(0.0, 0.0, 1.0), to_eye);
  vec3 side = across_of(axis, to_eye);
  float reach = shown + 0.5 * length(streak);
  slenderness = shown / reach;
  hollow = 0.0;
  on_strip = vec2(2.0 * corner.x - 1.0, corner.y);
  vec3 world = center + axis * on_strip.x * reach + side * on_strip.y * shown;
  vec3 off = abs(center - box.xyz) / box.w;
  float inside = 1.0 - smoothstep(0.75, 1.0, max(off.x, max(off.y, off.z)));
  float range = distance(center, frame.eye.xyz);
  float nearness = smoothstep(0.45, 0.95, range / frame.water.w);
  opacity = inside * nearness * (radius * radius) / (shown * shown) * sqrt(slenderness) * exp(-0.5 * range / frame.water.w);
  opacity *= share * step(frame.ground.w, center.z);
  gl_Position = frame.view_projection * vec4(world, 1.0);
}
