// The key light on the floor, as a map: soft shadows cost once a texel and not once a pixel.
#include "frame.glsl"
#include "shadow.glsl"
layout(location = 0) in vec2 place;
layout(location = 0) out float visibility;

void main() {
  vec3 point = vec3(frame.ground.xy + frame.ground.z * place, frame.ground.w);
  visibility = key_visibility(point, vec3(0.0, 0.0, 1.0), pixel_noise(gl_FragCoord.xy));
}
