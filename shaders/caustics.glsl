// SPDX-License-Identifier: Apache-2.0
// The pattern of light below a moving water surface, mean 1. Needs frame.glsl.
// OCTAVES: how many sizes of the pattern are visible, 1 or 2 (see Octave in render/frame_block.h).
layout(binding = 4) uniform sampler2D caustics_tile;

// The pattern is projected along the key light's direction. `blur` = how many levels of detail to skip.
float caustics(vec3 point, float blur) {
  vec2 surface_point = point.xy - frame.to_key.xy / frame.to_key.z * point.z;
#if OCTAVES == 1
  float light = texture(caustics_tile, surface_point * (4.0 / frame.octave.x), blur).r;
#else
  float light = mix(texture(caustics_tile, surface_point * (4.0 / frame.octave.x), blur).r,
                    texture(caustics_tile, surface_point * (4.0 / frame.octave.y), blur).r, frame.octave.z);
#endif
  return 1.0 + frame.water.y * (light - 1.0);
}
