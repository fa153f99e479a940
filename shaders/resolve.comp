// SPDX-License-Identifier: Apache-2.0
// Resolves samples of linear light to one pixel. Applies the tone curve to each sample before averaging, so that edges of
// bright things stay smooth.
#include "frame.glsl"
#include "tone.glsl"
layout(local_size_x = 8, local_size_y = 8) in;
layout(binding = 0) uniform sampler2DMS samples;
layout(binding = 8) uniform sampler2D glow;
layout(binding = 0, rgba8) writeonly uniform image2D picture;  // gamma-encoded
layout(location = 0) uniform float vignette;

void main() {
  ivec2 texel = ivec2(gl_GlobalInvocationID.xy), size = imageSize(picture);
  if (any(greaterThanEqual(texel, size))) return;
  vec2 uv = (vec2(texel) + 0.5) / vec2(size);
  vec3 spread = textureLod(glow, uv, 0.0).rgb;
  vec2 off = (uv - 0.5) * vec2(1.0, 0.8);
  float dim = 1.0 - vignette * smoothstep(0.1, 0.75, dot(off, off) * 2.0);
  vec3 light[SAMPLES];
  bool edge = false;
  for (int i = 0; i < SAMPLES; ++i) {
    light[i] = texelFetch(samples, texel, i).rgb;
    edge = edge || light[i] != light[0];
  }
  vec3 mapped = tone_mapped(dim * (max(light[0], vec3(0.0)) + spread));
  // A loop, since renderers on the CPU compute both sides of an if.
  for (int once = 0; once < int(edge); ++once) {
    for (int i = 1; i < SAMPLES; ++i) mapped += tone_mapped(dim * (max(light[i], vec3(0.0)) + spread));
    mapped /= float(SAMPLES);
  }
  // Dithering: one step of the 8-bit sRGB code, in linear light.
  vec3 step_size = (0.08 + 2.2 * sqrt(mapped)) / 255.0;
  vec3 dithered = mapped + (pixel_noise(vec2(texel) + 0.5) - 0.5) * step_size;
  imageStore(picture, texel, vec4(gamma_encoded(clamp(dithered, 0.0, 1.0)), 1.0));
}
