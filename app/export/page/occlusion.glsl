// SPDX-License-Identifier: Apache-2.0
// The share of ambient light that arrives, in place of the occlusion pass of the program: bodies seen from above as a
// map of heights, and how high they rise around a point.
#include "shadow.glsl"
uniform sampler2D roof;   // 0 = `roof_box.w` high, 1 = nothing above the floor
uniform vec4 roof_box;    // corner x, y and side [m]; height of the highest body [m]
uniform vec2 roof_range;  // depth of the map, radius of the samples [m]

float open_sky(vec3 point, vec3 normal) {
  const int taps = 10;
  float hidden = 0.0;
  mat2 turned = turned_by(6.2831853 * pixel_noise(gl_FragCoord.xy));
  vec3 from = point + 0.06 * roof_range.y * normal;
  for (int i = 0; i < taps; ++i) {
    vec2 off = roof_range.y * turned * disc_point(i, taps);
    vec2 at = (from.xy + off - roof_box.xy) / roof_box.z;
    float d = textureLod(roof, at, 0.0).r;
    if (d >= 1.0 || any(lessThan(at, vec2(0.0))) || any(greaterThan(at, vec2(1.0)))) continue;
    float rise = roof_box.w - d * roof_range.x - from.z;
    hidden += clamp(rise / (length(off) + 0.25 * roof_range.y), 0.0, 1.0);
  }
  return 1.0 - 0.75 * hidden / float(taps);
}

// For backdrop.frag: of the ground at a pixel, `range` along the camera's axis.
float openness(vec2 pixel, float range) {
  vec2 uv = pixel * frame.screen.zw;
  vec3 sight = sight_through(uv);
  return range > 0.0 ? open_sky(frame.eye.xyz + range * sight, vec3(0.0, 0.0, 1.0)) : 1.0;
}
