// SPDX-License-Identifier: Apache-2.0
// Ambient occlusion at half the picture's size: the obscurance of McGuire et al. 2011.
#include "frame.glsl"
layout(local_size_x = 8, local_size_y = 8) in;
layout(binding = 0) uniform sampler2D depths;
layout(binding = 0, rg16f) writeonly uniform image2D map;  // share of ambient light that arrives, depth

layout(location = 0) uniform float radius;  // [m]

#ifndef OCCLUSION_TAPS
#define OCCLUSION_TAPS 8
#endif
#ifndef DEPTH_STEP
#define DEPTH_STEP 1
#endif

// The point of a texel of the half-size picture, from one texel of `depths`, which has DEPTH_STEP times the resolution.
vec3 at(ivec2 texel) {
  ivec2 size = textureSize(depths, 0);
  ivec2 from = DEPTH_STEP * texel;
  float range = distance_of_depth(texelFetch(depths, clamp(from, ivec2(0), size - 1), 0).r);
  return vec3((2.0 * (vec2(from) + 0.5) / vec2(size) - 1.0) * frame.depth.zw + frame.lens.xy, -1.0) * range;
}

// The flatter of two differences, which does not cross an edge.
vec3 flatter(vec3 a, vec3 b) { return abs(a.z) < abs(b.z) ? a : b; }

void main() {
  ivec2 texel = ivec2(gl_GlobalInvocationID.xy);
  if (any(greaterThanEqual(texel, imageSize(map)))) return;
  vec3 point = at(texel);
  float range = -point.z;
  bool seen = texelFetch(depths, min(DEPTH_STEP * texel, textureSize(depths, 0) - 1), 0).r > 0.0;
  float open = 1.0;
  // A loop, since renderers on the CPU compute both sides of an if.
  for (int once = 0; once < int(seen); ++once) {
    vec3 right = flatter(at(texel + ivec2(1, 0)) - point, point - at(texel - ivec2(1, 0)));
    vec3 up = flatter(at(texel + ivec2(0, 1)) - point, point - at(texel - ivec2(0, 1)));
    vec3 normal = normalize(cross(right, up));
    float reach = radius / (range * frame.depth.w) * 0.5 * float(textureSize(depths, 0).y) / float(DEPTH_STEP);  // [texels]
    // Neighboring texels use different sample patterns, repeating every 4 x 4; occlusion_blur.comp averages them.
    int cell = (texel.x & 3) + 4 * ((texel.y ^ (texel.x << 1)) & 3);
    float turn = 6.2831853 * (float(cell) + 0.5) / 16.0;
    float hidden = 0.0;
    for (int i = 0; i < OCCLUSION_TAPS; ++i) {
      float far = (float(i) + 0.5) / float(OCCLUSION_TAPS);
      float angle = turn + 6.2831853 * 0.381966 * float(i) * 1.0;
      ivec2 offset = ivec2(round(reach * far * vec2(cos(angle), sin(angle))));
      if (offset == ivec2(0)) continue;
      vec3 v = at(texel + offset) - point;
      float squared = dot(v, v);
      float fade = max(0.0, 1.0 - squared / (radius * radius));
      hidden += fade * fade * fade * max(0.0, dot(v, normal) - 0.004 * range) * inversesqrt(squared + 1e-8);
    }
    open = max(0.0, 1.0 - 2.6 * hidden / float(OCCLUSION_TAPS));
  }
  imageStore(map, texel, vec4(open, range, 0.0, 0.0));
}
