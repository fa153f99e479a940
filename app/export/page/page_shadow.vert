// SPDX-License-Identifier: Apache-2.0
// A corner of a skin in a view along parallel lines: the light's, or from above.
#include "direction.glsl"
#include "seen_face.glsl"
#include "skins.glsl"
layout(location = 0) in uint corner;
uniform mat4 to_map;  // x, y and depth from 0 to 1

void main() {
  uint own = texelFetch(faces, texel_of(2u * (corner / 3u)), 0)[corner % 3u];
  vec3 on_map = (to_map * vec4(mass_at(own).xyz, 1.0)).xyz;
  gl_Position = vec4(2.0 * on_map - 1.0, 1.0);
}
