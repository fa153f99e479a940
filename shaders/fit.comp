// SPDX-License-Identifier: Apache-2.0
// Fills in the part of the frame block that depends on where bodies are: what the shadow map and the floor's light map
// cover. One work group. On the GPU, because reading boxes back would make the CPU wait in every picture.
#define FITS_FRAME
#include "frame.glsl"
#include "bodies.glsl"
layout(local_size_x = 256) in;

struct Box {
  vec4 low, high;
};
layout(std430, binding = 11) readonly buffer Boxes { Box boxes[]; };
layout(location = 0) uniform uint bodies;
layout(location = 1) uniform vec2 sides;  // of the shadow map and of the floor's light map [texels]

shared vec3 lows[256];
shared vec3 highs[256];
shared float ranges[256];

// Rounds up to a multiple of an eighth of the power of two below it, so that the size rarely changes.
float stepped(float size) {
  int exponent;
  frexp(max(size, 1e-6), exponent);
  float unit = ldexp(1.0, exponent - 1) / 8.0;
  return unit * ceil(size / unit);
}

float rounded(float x, float unit) { return unit * floor(x / unit + 0.5); }

// How far the nearest point of a box can be from the eye, along the camera's axis [m]; far away if the picture does not
// show the box.
float nearest_range(vec3 low, vec3 high) {
  vec3 middle = (frame.view * vec4(0.5 * (low + high), 1.0)).xyz;
  float radius = 0.5 * length(high - low), range = -middle.z;
  vec2 beyond = (abs(middle.xy) - range * frame.depth.zw) * inversesqrt(1.0 + frame.depth.zw * frame.depth.zw);
  if (range + radius < frame.depth.x || max(beyond.x, beyond.y) > radius) return 1e30;
  return max(range - radius, frame.depth.x);
}

// The light's view covers everything that can cast a shadow. A large map covers more than that if its texels would be much
// smaller than the picture's pixels on the nearest body, `range` meters away: finer ones cost time and show nothing.
void fit_shadow(bool any, vec3 low, vec3 high, float range) {
  vec3 back = frame.to_key.xyz;
  vec3 right = normalize(cross(vec3(0.0, 1.0, 0.0), back));
  vec3 up = cross(back, right);
  vec3 middle = any ? 0.5 * (low + high) : vec3(0.0);
  vec3 half_size = any ? 0.5 * (high - low) : vec3(1.0);
  float width = stepped(2.1 * max(max(dot(half_size, abs(right)), dot(half_size, abs(up))), 1e-3));
  float depth = stepped(2.1 * max(dot(half_size, abs(back)), 1e-3));
  float pixel = 2.0 * range * frame.depth.w * frame.screen.w;
  if (range < 1e30) width = clamp(stepped(0.75 * pixel * sides.x), width, width * max(1.0, sides.x / 2048.0));
  // Whole texels, so that shadows do not crawl while bodies move.
  float texel = width / sides.x;
  mat4 rows = mat4(vec4(right, -rounded(dot(middle, right), texel)) / width,
                   vec4(up, -rounded(dot(middle, up), texel)) / width, vec4(-back, dot(middle, back)) / depth,
                   vec4(0.0, 0.0, 0.0, 1.0));
  mat4 to_map = transpose(rows);
  to_map[3].xyz += 0.5;
  frame.shadow = to_map;
  frame.shadow_size = vec4(width, depth, 0.0, 0.0);
}

// The floor's light map covers every place where shadows can fall.
void fit_ground(bool any, vec3 low, vec3 high) {
  vec3 to_key = frame.to_key.xyz;
  float drop = any ? max(0.0, high.z - frame.ground.w) / max(to_key.z, 0.2) : 0.0;
  if (!any) {
    low = vec3(-1.0, -1.0, 0.0);
    high = vec3(1.0, 1.0, 0.0);
  }
  vec3 fallen_low = min(low, low - drop * to_key), fallen_high = max(high, high - drop * to_key);
  float margin = 0.05 * length(fallen_high - fallen_low) + drop * frame.to_key.w;
  vec2 size = fallen_high.xy - fallen_low.xy + 2.0 * margin;
  float side = stepped(max(size.x, size.y));
  vec2 corner = 0.5 * (fallen_low.xy + fallen_high.xy) - 0.5 * side;
  float texel = side / sides.y;
  frame.ground.xyz = vec3(rounded(corner.x, texel), rounded(corner.y, texel), side);
}

void main() {
  uint lane = gl_LocalInvocationID.x;
  vec3 low = vec3(1e30), high = vec3(-1e30);
  float range = 1e30;
  for (uint body = lane; body < bodies; body += 256u) {
    Box box = boxes[body];
    Placement placement = placements[body];
    if ((placement.flags & PLACEMENT_HIDDEN) != 0u || box.low.x > box.high.x) continue;
    vec3 box_low = box.low.xyz + placement.offset, box_high = box.high.xyz + placement.offset;
    low = min(low, box_low);
    high = max(high, box_high);
    range = min(range, nearest_range(box_low, box_high));
  }
  lows[lane] = low;
  highs[lane] = high;
  ranges[lane] = range;
  for (uint half_count = 128u; half_count > 0u; half_count /= 2u) {
    barrier();
    if (lane < half_count) {
      lows[lane] = min(lows[lane], lows[lane + half_count]);
      highs[lane] = max(highs[lane], highs[lane + half_count]);
      ranges[lane] = min(ranges[lane], ranges[lane + half_count]);
    }
  }
  if (lane != 0u) return;
  bool any = lows[0].x <= highs[0].x;
  fit_shadow(any, lows[0], highs[0], ranges[0]);
  fit_ground(any, lows[0], highs[0]);
  frame.water.z = any ? highs[0].z : 0.0;
}
