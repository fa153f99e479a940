// SPDX-License-Identifier: Apache-2.0
// From the depths of prints to what shades the ground: its slope, how much it is pressed (0 to 1), and the share of the
// key light that the walls of prints let through.
#include "prints.glsl"
layout(local_size_x = 8, local_size_y = 8) in;
layout(binding = 0) uniform sampler2D depth_and_rim;
layout(binding = 0, rgba8) writeonly uniform image2D relief;
layout(location = 0) uniform vec3 to_key;
layout(location = 1) uniform ivec2 first;  // texel

// Where prints meet, the pressed ground of one has no rim of the other.
float height(vec2 there) { return max(there.y - 2.0 * there.x, 0.0) - there.x; }

float height_at(ivec2 texel) { return height(texelFetch(depth_and_rim, texel, 0).rg); }

void main() {
  ivec2 texel = first + ivec2(gl_GlobalInvocationID.xy), size = imageSize(relief);
  if (any(greaterThanEqual(texel, size))) return;
  vec2 here = texelFetch(depth_and_rim, texel, 0).rg;
  if (here == vec2(0.0)) return;  // neither a print nor its rim, as the map was cleared
  float side = prints.map.z / float(size.x);
  float own = height(here);
  ivec2 low = max(texel - 1, ivec2(0)), high = min(texel + 1, size - 1);
  vec2 slope = vec2(height_at(ivec2(high.x, texel.y)) - height_at(ivec2(low.x, texel.y)),
                    height_at(ivec2(texel.x, high.y)) - height_at(ivec2(texel.x, low.y))) / (2.0 * side);
  // Toward the key light, as far as the highest rim could hide it.
  float lit = 1.0;
  const int steps = 10;
  float rise = to_key.z / max(length(to_key.xy), 1e-3);
  float reach = min((0.34 * prints.map.w - own) / rise, 24.0 * side);
  vec2 along = to_key.xy / max(length(to_key.xy), 1e-3);
  if (reach > 0.5 * side)
    for (int i = 1; i <= steps; ++i) {
      float off = reach * float(i) / float(steps);
      vec2 at = (vec2(texel) + 0.5 + along * off / side) / vec2(size);
      float above = height(textureLod(depth_and_rim, at, 0.0).rg) - own - off * rise;
      lit = min(lit, 1.0 - 0.75 * smoothstep(0.0, 0.4 * prints.map.w, above));
    }
  // Prints end before the map does.
  vec2 from_edge = vec2(min(texel, size - 1 - texel)) / vec2(size);
  float there = smoothstep(0.01, 0.06, min(from_edge.x, from_edge.y));
  imageStore(relief, texel,
             vec4(stored_slope(there * slope), there * min(here.x / prints.map.w, 1.0), mix(1.0, lit, there)));
}
