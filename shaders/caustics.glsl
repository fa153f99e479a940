// The pattern of light that a moving water surface throws down, mean 1. Needs frame.glsl.
layout(binding = 4) uniform sampler2D caustics_tile;

// Follows the key light's direction down to the point.
// `blur` = levels of detail that are left out.
float caustics(vec3 point, float blur) {
  vec2 place = point.xy - frame.to_key.xy / frame.to_key.z * point.z;
  float light = 0.0;
  if (frame.octave.z < 1.0) light += (1.0 - frame.octave.z) * texture(caustics_tile, place * (4.0 / frame.octave.x), blur).r;
  if (frame.octave.z > 0.0) light += frame.octave.z * texture(caustics_tile, place * (4.0 / frame.octave.y), blur).r;
  return 1.0 + frame.water.y * (light - 1.0);
}
