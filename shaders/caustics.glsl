// SPDX-License-Identifier: Apache-2.0
// The pattern of light below a moving water surface, mean 1. Needs frame.glsl.
// OCTAVES: how many sizes of the pattern are visible, 1 or 2 (see Octave in render/passes/scene_buffers.h).
layout(binding = 4) uniform sampler2D caustics_tile;

// Where the key light that arrives at a point has passed the surface.
vec2 surface_point(vec3 point) { return point.xy - frame.to_key.xy / frame.to_key.z * point.z; }

// One size of the pattern. `footprint` = what a pixel covers of the surface [m]; fragment shaders know it from derivatives.
float caustics_of_size(float size, vec2 at, float footprint, float blur) {
  float scale = 4.0 / size;
#ifdef CAUSTICS_IN_COMPUTE
  float texels = footprint * scale * float(textureSize(caustics_tile, 0).x);
  return textureLod(caustics_tile, at * scale, log2(max(texels, 1e-6)) + blur).r;
#else
  return texture(caustics_tile, at * scale, blur).r;
#endif
}

// `blur` = how many levels of detail to skip.
float caustics(vec2 at, float footprint, float blur) {
  float light = caustics_of_size(frame.octave.x, at, footprint, blur);
#if OCTAVES != 1
  light = mix(light, caustics_of_size(frame.octave.y, at, footprint, blur), frame.octave.z);
#endif
  return 1.0 + frame.water.y * (light - 1.0);
}

// On bodies: softer, so that their own colors are seen.
float caustics_on_skin(vec2 at, float footprint) { return mix(1.0, caustics(at, footprint, 1.8), 0.7); }
