// SPDX-License-Identifier: Apache-2.0
// Ends every shader whose color goes to the screen, as resolve.comp ends a picture of the program.
#include "tone.glsl"
uniform float vignette;

void main() {
  light_of_pixel();
  vec2 off = (gl_FragCoord.xy * frame.screen.zw - 0.5) * vec2(1.0, 0.8);
  float dim = 1.0 - vignette * smoothstep(0.1, 0.75, dot(off, off) * 2.0);
  vec3 mapped = tone_mapped(dim * max(color.rgb, vec3(0.0)));
  // One step of the 8-bit sRGB code, so that slow gradients show no bands.
  mapped += (pixel_noise(gl_FragCoord.xy) - 0.5) * (0.08 + 2.2 * sqrt(mapped)) / 255.0;
  color.rgb = gamma_encoded(clamp(mapped, 0.0, 1.0));
}
