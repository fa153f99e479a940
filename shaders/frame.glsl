// SPDX-License-Identifier: Apache-2.0
// The data that all shaders of one picture share: FrameBlock of render/passes/scene_buffers.h.
// FITS_FRAME: writable, for fit.comp, which fills in a part of it.
#ifdef FITS_FRAME
layout(std140, binding = 0) buffer Frame {
#else
layout(std140, binding = 0) uniform Frame {
#endif
  mat4 view_projection;          // world to clip, depth reversed
  mat4 inverse_view_projection;
  mat4 view;                     // world to eye, which looks along -z
  mat4 shadow;                   // world to shadow map and its depth
  vec4 eye;                      // world; w = time [s]
  vec4 to_key;                   // direction toward the key light; w = tangent of its half angle
  vec4 key_light;                // linear light; w = strength of muscles' glow
  vec4 sky_light;                // from straight above; w = how fast haze over land gives way to blue sky
  vec4 ground_light;             // from straight below
  vec4 backdrop_high;            // light from far away, looking up and level
  vec4 backdrop_low;             // the same, looking down; on land, straight up
  vec4 floor_color;
  vec4 line_color;               // of the grid on land; w = 1 if the whole ground has it
  vec4 fog;                      // extinction [1/m]; w = distance where it begins [m]
  vec4 screen;                   // width, height, 1/width, 1/height [pixels]
  vec4 depth;                    // near, far [m]; half width and height of the picture at distance 1
  vec4 shadow_size;              // width and depth of what the shadow map covers [m]
  vec4 ground;                   // corner x, y and side of the floor's light map, height of the floor [m]
  vec4 water;                    // Surroundings, strength of caustics, height of the highest body, distance to target
  vec4 octave;                   // Octave: size, its double, share of the double
  vec4 lens;                     // Camera::shift, x and y; added to pixel_noise(); how far light shines into bodies [m]
} frame;

// Values of AROUND (Surroundings in render/scene.h), for shaders that depend on it.
#define AROUND_NONE 0
#define AROUND_WATER 1
#define AROUND_LAND 2

// The distance along the camera's axis of a value in the depth buffer; `far` for the backdrop.
float distance_of_depth(float d) {
  return frame.depth.x * frame.depth.y / (frame.depth.x + d * (frame.depth.y - frame.depth.x));
}

vec3 backdrop(vec3 sight) {
  if (int(frame.water.x) == AROUND_LAND) return frame.backdrop_high.rgb;  // haze; backdrop_low is the zenith
  return mix(frame.backdrop_low.rgb, frame.backdrop_high.rgb, smoothstep(-0.75, 0.15, sight.z));
}

// Light from a point at that distance, after absorption, plus the light that water or air scatters into the line of sight.
vec3 through_fog(vec3 light, vec3 sight, float range) {
  vec3 left = exp(-frame.fog.rgb * max(0.0, range - frame.fog.w));
  return light * left + backdrop(sight) * (1.0 - left);
}

// A number in [0, 1) per pixel, evenly spread within each neighborhood (interleaved gradient noise, Jimenez 2014).
float pixel_noise(vec2 pixel) {
  return fract(frame.lens.z + 52.9829189 * fract(dot(floor(pixel), vec2(0.06711056, 0.00583715))));
}

// From the eye through a place of the picture, in the world; of length 1 along the camera's axis.
vec3 sight_through(vec2 uv) {
  return transpose(mat3(frame.view)) * vec3((2.0 * uv - 1.0) * frame.depth.zw + frame.lens.xy, -1.0);
}
