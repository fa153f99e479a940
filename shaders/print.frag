// SPDX-License-Identifier: Apache-2.0
// How deep a print is at a point, and how high the sand around it. Blending keeps the largest of all prints.
layout(location = 0) in vec2 world;
layout(location = 1) flat in vec4 a_b;
layout(location = 2) flat in vec4 c_radius_depth;
layout(location = 0) out vec2 depth_and_rim;  // [m]

float squared_to_edge(vec2 p, vec2 a, vec2 b) {
  vec2 along = b - a, from = p - a;
  vec2 off = from - along * clamp(dot(from, along) / max(dot(along, along), 1e-12), 0.0, 1.0);
  return dot(off, off);
}

float cross_product(vec2 a, vec2 b) { return a.x * b.y - a.y * b.x; }

// The distance to a triangle; 0 inside.
float to_triangle(vec2 p, vec2 a, vec2 b, vec2 c) {
  vec3 sides = vec3(cross_product(b - a, p - a), cross_product(c - b, p - b), cross_product(a - c, p - c));
  bool inside = all(greaterThan(sides, vec3(0.0))) || all(lessThan(sides, vec3(0.0)));
  return inside ? 0.0 : sqrt(min(min(squared_to_edge(p, a, b), squared_to_edge(p, b, c)), squared_to_edge(p, c, a)));
}

void main() {
  float off = to_triangle(world, a_b.xy, a_b.zw, c_radius_depth.xy) / c_radius_depth.z;
  float rim = smoothstep(0.70, 1.20, off) * (1.0 - smoothstep(1.20, 2.40, off));
  depth_and_rim = c_radius_depth.w * vec2(1.0 - smoothstep(0.25, 1.05, off), 0.34 * rim);
}
