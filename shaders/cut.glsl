// SPDX-License-Identifier: Apache-2.0
// Cut bodies are drawn as solid: where the back of a skin is visible through the cut, the cut's plane is drawn instead.
// Needs frame.glsl.

// The point where a line of sight crosses the cut's plane. The eye is on the removed side.
vec3 point_of_cut(vec3 sight) {
  float share = (frame.cut.w - dot(frame.cut.xyz, frame.eye.xyz)) / min(dot(frame.cut.xyz, sight), -1e-6);
  return frame.eye.xyz + share * sight;
}

// The value of a point in the depth buffer.
float depth_of(vec3 point) {
  vec4 clip = frame.view_projection * vec4(point, 1.0);
  return clip.z / clip.w;
}
