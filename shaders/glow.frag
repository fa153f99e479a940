// SPDX-License-Identifier: Apache-2.0
// Extracts the glowing light from the picture, at a quarter of its size; blur.frag spreads it.
layout(binding = 0) uniform sampler2DMS samples;
layout(location = 0) in vec2 uv;
layout(location = 0) out vec4 light;

void main() {
  ivec2 corner = ivec2(gl_FragCoord.xy) * 4;
  ivec2 last = textureSize(samples) - 1;
  vec3 sum = vec3(0.0);
  for (int i = 0; i < 4; ++i) {
    vec4 value = texelFetch(samples, min(corner + ivec2(1 + 2 * (i & 1), 1 + (i & 2)), last), 0);
    sum += min(max(value.rgb, vec3(0.0)) * value.a, vec3(8.0));
  }
  light = vec4(0.25 * sum, 1.0);
}
