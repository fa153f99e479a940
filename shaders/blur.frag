// SPDX-License-Identifier: Apache-2.0
// One of the two passes of a Gaussian blur: along one axis.
layout(binding = 0) uniform sampler2D source;
layout(location = 0) in vec2 uv;
layout(location = 0) out vec4 result;
layout(location = 0) uniform vec2 stride;  // between samples, in texture coordinates

void main() {
  vec3 sum = vec3(0.0);
  float weights = 0.0;
  for (int i = -6; i <= 6; ++i) {
    float weight = exp(-0.09 * float(i * i));
    sum += weight * textureLod(source, uv + float(i) * stride, 0.0).rgb;
    weights += weight;
  }
  result = vec4(sum / weights, 1.0);
}
