// SPDX-License-Identifier: Apache-2.0
// Bodies are solid: where a cut lets the eye see the back of a skin, it sees the cut instead. Needs frame.glsl.

// Where the line of sight comes through the cut, which the eye is beyond.
vec3 point_of_cut(vec3 sight) {
  float share = (frame.cut.w - dot(frame.cut.xyz, frame.eye.xyz)) / min(dot(frame.cut.xyz, sight), -1e-6);
  return frame.eye.xyz + share * sight;
}

// In the depth buffer.
float depth_of(vec3 point) {
  vec4 clip = frame.view_projection * vec4(point, 1.0);
  return clip.z / clip.w;
}
