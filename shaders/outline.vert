// SPDX-License-Identifier: Apache-2.0
// A rectangle around a selected body in the picture, as 6 vertices.
#include "frame.glsl"
#include "bodies.glsl"
struct Box {
  vec4 low, high;
};
layout(std430, binding = 11) readonly buffer Boxes { Box boxes[]; };
layout(std430, binding = 12) readonly buffer Selected { uint selected[]; };
layout(location = 0) uniform vec2 line;    // widths of the line and of its dark edge [pixels]
layout(location = 1) uniform float reach;  // of balls and bars around masses [m]
out gl_PerVertex { vec4 gl_Position; };

void main() {
  uint body = selected[gl_VertexID / 6];
  int vertex = gl_VertexID % 6;
  vec2 corner = vec2(vertex == 1 || vertex == 3 || vertex == 4, vertex == 2 || vertex == 4 || vertex == 5);
  Box box = boxes[body];
  vec2 low = vec2(1.0), high = vec2(-1.0);
  for (int i = 0; i < 8; ++i) {
    vec3 point = mix(box.low.xyz - reach, box.high.xyz + reach, vec3(i & 1, (i >> 1) & 1, i >> 2)) + placements[body].offset;
    vec4 clip = frame.view_projection * vec4(point, 1.0);
    if (clip.w < frame.depth.x) {  // behind the eye: it may cover the whole picture
      low = vec2(-1.0);
      high = vec2(1.0);
      break;
    }
    low = min(low, clip.xy / clip.w);
    high = max(high, clip.xy / clip.w);
  }
  vec2 margin = 2.0 * (line.x + line.y + 3.0) * frame.screen.zw;
  gl_Position = vec4(mix(low - margin, high + margin, corner), 0.5, 1.0);
}
