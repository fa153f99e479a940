// SPDX-License-Identifier: Apache-2.0
// A bright line around the silhouettes of selected bodies, with a dark edge, so that it is visible on any ground.
#include "frame.glsl"
layout(binding = 0) uniform sampler2D silhouettes;  // depth of selected bodies; 0 = none
layout(binding = 1) uniform sampler2DMS depths;     // of everything
layout(location = 0) uniform vec2 line;             // widths of the line and of its dark edge [pixels]
layout(location = 0) out vec4 color;

void main() {
  ivec2 at = ivec2(gl_FragCoord.xy), last = textureSize(silhouettes, 0) - 1;
  if (texelFetch(silhouettes, at, 0).r > 0.0) discard;
  int reach = int(ceil(line.x + line.y));
  float nearest = 1e9, depth = 0.0;
  for (int y = -reach; y <= reach; ++y)
    for (int x = -reach; x <= reach; ++x) {
      float squared = float(x * x + y * y);
      if (squared >= nearest) continue;
      float there = texelFetch(silhouettes, clamp(at + ivec2(x, y), ivec2(0), last), 0).r;
      if (there <= 0.0) continue;
      nearest = squared;
      depth = there;
    }
  float off = sqrt(nearest);
  float cover = clamp(line.x + line.y + 0.5 - off, 0.0, 1.0);
  if (cover <= 0.0) discard;
  // Something nearer to the eye than the body hides the line.
  if (distance_of_depth(texelFetch(depths, at, 0).r) < 0.998 * distance_of_depth(depth)) discard;
  float dark = clamp(off - line.x + 0.5, 0.0, 1.0);
  color = vec4(mix(vec3(1.0, 0.86, 0.42), vec3(0.0), dark), cover * mix(1.0, 0.55, dark));
}
