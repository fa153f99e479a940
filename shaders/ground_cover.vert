// SPDX-License-Identifier: Apache-2.0
// A plant or a stone. PLANT: blades that bend, each a strip that narrows to its tip; else a stone.
#include "frame.glsl"
#include "ground_cover.glsl"
#include "ribbon.glsl"
layout(std430, binding = 13) readonly buffer Items { Item items[]; };
layout(std430, binding = 14) readonly buffer Lists { uint lists[]; };
layout(location = 0) uniform uint first;   // of the list
layout(location = 1) uniform vec4 wind;    // how far plants lean, x and y; how far they sway, as shares of their height
layout(location = 2) uniform vec2 slender; // width of a blade and of a tuft, as shares of the height

layout(location = 0) out vec3 world;
layout(location = 1) out vec3 normal;
layout(location = 2) out float along;      // from the foot to the tip, 0 to 1
layout(location = 3) flat out float own;   // Item::phase
out gl_PerVertex { vec4 gl_Position; };

#ifdef PLANT
float spread_number(float phase, int blade) { return fract(phase * 17.0 + 0.6180340 * float(blade)); }

// The middle of a blade at a share of its length.
vec3 blade_point(Item item, int blade, float share) {
  float a = spread_number(item.phase, blade), b = fract(7.31 * a + 0.37 * item.phase);
  float angle = item.turn + 6.2831853 * a;
  vec2 out_of_middle = vec2(cos(angle), sin(angle));
  float length_of = item.height * (0.35 + 0.65 * b);
  vec2 foot = item.foot.xy + out_of_middle * slender.y * item.height * (0.15 + 0.5 * fract(3.7 * b));
  // Whole numbers of turns per hour, after which the time begins again.
  float time = frame.eye.w * 6.2831853 / 3600.0;
  float sway = sin(430.0 * time + 5.0 * b + 1.3 * dot(item.foot.xy, vec2(0.8, 0.6)) / max(item.height, 1e-6)) * 0.7 +
               0.3 * sin(997.0 * time + 6.2831853 * item.phase);
  vec2 bend = wind.xy + out_of_middle * 0.26 * (0.4 + b) + vec2(0.8, 0.6) * wind.z * sway;
  bend *= share * share;
  float fall = 0.45 * dot(bend, bend);
  return vec3(foot + length_of * bend, item.foot.z + length_of * share * max(1.0 - fall, 0.3));
}
#else
float bumps(vec3 d, float phase) {
  vec3 p = d * 1.35 + 37.0 * phase;
  return 1.0 + 0.15 * sin(p.x + 1.7 * p.y) + 0.12 * sin(1.9 * p.y - p.z + 2.0) + 0.08 * sin(2.6 * p.z + 1.1 * p.x);
}
vec3 stone_point(vec3 d, Item item) {
  float c = cos(item.turn), s = sin(item.turn);
  vec3 p = d * bumps(d, item.phase) * vec3(1.25 + 0.5 * fract(5.0 * item.phase), 1.0, 0.72);
  return item.foot + item.height * vec3(c * p.x - s * p.y, s * p.x + c * p.y, p.z) * 1.2;
}
vec3 on_sphere(vec2 at) {
  float angle = 6.2831853 * at.x, z = 1.0 - 1.08 * at.y;  // the rest is in the ground
  return vec3(sqrt(max(1.0 - z * z, 0.0)) * vec2(cos(angle), sin(angle)), z);
}
#endif

void main() {
  Item item = items[lists[first + uint(gl_InstanceID)]];
  own = item.phase;
#ifdef PLANT
  int blade = gl_VertexID / (2 * (SEGMENTS + 1));
  float across = float(gl_VertexID % 2) * 2.0 - 1.0;
  along = float((gl_VertexID / 2) % (SEGMENTS + 1)) / float(SEGMENTS);
  vec3 point = blade_point(item, blade, along);
  vec3 axis = blade_point(item, blade, along + 0.05) - blade_point(item, blade, along - 0.05);
  vec3 to_eye = normalize(frame.eye.xyz - point);
  vec3 side = across_of(normalize(axis), to_eye);
  float width = max(0.5 * slender.x * item.height * (0.75 + 0.5 * own), 0.35 * pixel_size(point));
  width *= along < 0.999 ? mix(0.8, 1.0, smoothstep(0.0, 0.4, along)) * sqrt(max(1.0 - along, 0.0)) * 1.15 : 0.0;
  world = point + side * across * width;
  normal = normalize(cross(side, normalize(axis)) + 0.5 * across * side);
#else
  ivec2 corner = ivec2(gl_VertexID % (COLUMNS + 1), gl_VertexID / (COLUMNS + 1));
  vec2 at = vec2(corner) / vec2(COLUMNS, ROWS);
  vec3 d = on_sphere(at);
  world = stone_point(d, item);
  vec3 u = normalize(cross(d, abs(d.z) < 0.9 ? vec3(0.0, 0.0, 1.0) : vec3(1.0, 0.0, 0.0))), v = cross(d, u);
  vec3 du = stone_point(normalize(d + 0.05 * u), item) - stone_point(normalize(d - 0.05 * u), item);
  vec3 dv = stone_point(normalize(d + 0.05 * v), item) - stone_point(normalize(d - 0.05 * v), item);
  normal = normalize(cross(du, dv));  // outward, as u, v and d are right-handed
  along = clamp((world.z - item.foot.z) / max(item.height, 1e-6), 0.0, 1.0);
#endif
  gl_Position = frame.view_projection * vec4(world, 1.0);
}
