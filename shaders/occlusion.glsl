// Ambient light that nearby things leave, from the half-size map of occlusion.frag. Needs frame.glsl.
layout(binding = 3) uniform sampler2D occlusion_map;  // openness, distance along the line of sight

// Of the four nearest values those count that lie at this pixel's own distance.
float openness(vec2 pixel, float range) {
  vec2 at = 0.5 * pixel - 0.5;
  ivec2 corner = ivec2(floor(at));
  vec2 f = at - vec2(corner);
  ivec2 last = textureSize(occlusion_map, 0) - 1;
  float sum = 0.0, weights = 0.0;
  for (int i = 0; i < 4; ++i) {
    ivec2 step_to = ivec2(i & 1, i >> 1);
    vec2 value = texelFetch(occlusion_map, clamp(corner + step_to, ivec2(0), last), 0).rg;
    vec2 near = mix(1.0 - f, f, vec2(step_to));
    float weight = (near.x * near.y + 0.01) / (1e-3 + abs(value.g - range) / range * 40.0);
    sum += weight * value.r;
    weights += weight;
  }
  return sum / weights;
}
