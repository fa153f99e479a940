// The pattern of light that a moving water surface throws down, mean 1. Needs frame.glsl.
layout(binding = 4) uniform sampler2D caustics_tile;

// Follows the key light's direction down to the point. The pattern repeats after a metre times `frame.water.w` / 3.
// `blur` = levels of detail that are left out.
float caustics(vec3 point, float blur) {
  vec2 place = point.xy - frame.to_key.xy / frame.to_key.z * point.z;
  float scale = 4.0 / frame.water.w;
  return 1.0 + frame.water.y * (texture(caustics_tile, place * scale, blur).r - 1.0);
}
