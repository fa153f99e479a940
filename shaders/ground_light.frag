// The key light on the floor, as a map: soft shadows cost once a texel and not once a pixel.
#include "frame.glsl"
#include "shadow.glsl"
layout(location = 0) in vec2 place;
layout(location = 0) out float visibility;

void main() {
  vec3 point = vec3(frame.ground.xy + frame.ground.z * place, frame.ground.w);
  // A pattern of 4 x 4, which ground_blur.frag takes out again.
  ivec2 texel = ivec2(gl_FragCoord.xy);
  int cell = (texel.x & 3) + 4 * ((texel.y ^ (texel.x << 1)) & 3);
  visibility = key_visibility(point, vec3(0.0, 0.0, 1.0), (float(cell) + 0.5) / 16.0);
}
