// SPDX-License-Identifier: Apache-2.0
// The pattern of light that a moving water surface throws down, mean 1. Needs frame.glsl.
// OCTAVES: how many sizes of it are to be seen, 1 or 2.
layout(binding = 4) uniform sampler2D caustics_tile;

// Follows the key light's direction down to the point.
// `blur` = levels of detail that are left out.
float caustics(vec3 point, float blur) {
  vec2 place = point.xy - frame.to_key.xy / frame.to_key.z * point.z;
#if OCTAVES == 1
  float light = texture(caustics_tile, place * (4.0 / frame.octave.x), blur).r;
#else
  float light = mix(texture(caustics_tile, place * (4.0 / frame.octave.x), blur).r,
                    texture(caustics_tile, place * (4.0 / frame.octave.y), blur).r, frame.octave.z);
#endif
  return 1.0 + frame.water.y * (light - 1.0);
}
