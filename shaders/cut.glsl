// SPDX-License-Identifier: Apache-2.0
// Cut bodies are drawn as solid: where the back of a skin is visible through the cut, the cut's plane is drawn instead.
// Needs frame.glsl. `cut`: Placement::cut of the body.

// Added to the number of a body that is seen in its cut, where faces have their numbers.
#define CUT_BODY 0x80000000u

// The point where a line of sight crosses the cut's plane. The eye is on the removed side.
vec3 point_of_cut(vec4 cut, vec3 sight) {
  float share = (cut.w - dot(cut.xyz, frame.eye.xyz)) / min(dot(cut.xyz, sight), -1e-6);
  return frame.eye.xyz + share * sight;
}

// The value of a point in the depth buffer.
float depth_of(vec3 point) {
  vec4 clip = frame.view_projection * vec4(point, 1.0);
  return clip.z / clip.w;
}
