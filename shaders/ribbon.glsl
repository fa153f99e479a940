// SPDX-License-Identifier: Apache-2.0
// Flat strips that face the eye and are shaded as if round. Needs frame.glsl.

// Corner 0..5 of the strip's two triangles: x along it, 0 or 1; y across it, -1 or 1.
vec2 ribbon_corner(int vertex) {
  return vec2((vertex == 1 || vertex == 3 || vertex == 4) ? 1.0 : 0.0, (vertex == 2 || vertex == 4 || vertex == 5) ? 1.0 : -1.0);
}

// Width of a pixel at that point [m].
float pixel_size(vec3 point) {
  float range = -(frame.view * vec4(point, 1.0)).z;
  return max(range, frame.depth.x) * 2.0 * frame.depth.w * frame.screen.w;
}

// The direction across a strip along `axis` that faces `to_eye`.
vec3 across_of(vec3 axis, vec3 to_eye) {
  vec3 side = cross(axis, to_eye);
  float size = length(side);
  return size > 1e-12 ? side / size : vec3(0.0);
}
