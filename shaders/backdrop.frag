// What is seen where nothing stands.
#include "frame.glsl"
layout(location = 0) in vec2 place;
layout(location = 0) out vec4 color;

void main() {
  vec4 far = frame.inverse_view_projection * vec4(2.0 * place - 1.0, 0.0001, 1.0);
  vec3 sight = normalize(far.xyz / far.w - frame.eye.xyz);
  color = vec4(mix(frame.backdrop_low.rgb, frame.backdrop_high.rgb, smoothstep(-0.6, 0.3, sight.z)), 1.0);
}
