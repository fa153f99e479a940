// One tile of caustics: how strongly a surface of a few waves gathers light, 1 / |det of the map of its rays|.
#include "frame.glsl"
layout(location = 0) in vec2 place;
layout(location = 0) out float light;

void main() {
  const int waves = 12;
  // Whole numbers of waves a tile, so that it repeats without a seam.
  const vec2 vectors[waves] = vec2[](vec2(1, 3), vec2(3, -1), vec2(-2, 3), vec2(4, 1), vec2(-1, -4), vec2(3, -4),
                                     vec2(-5, 1), vec2(2, 5), vec2(5, 3), vec2(-3, 6), vec2(-6, -4), vec2(7, -2));
  float xx = 0.0, xy = 0.0, yy = 0.0;
  vec2 shift = vec2(0.0);
  for (int i = 0; i < waves; ++i) {
    vec2 k = vectors[i];
    float size = length(k);
    float speed = 1.2 * sqrt(size);  // deep water: longer waves run faster
    float phase = 6.2831853 * dot(k, place) - speed * frame.eye.w + 1.7 * float(i * i);
    float bend = 0.20 * sin(phase);
    xx += bend * k.x * k.x / (size * size);
    xy += bend * k.x * k.y / (size * size);
    yy += bend * k.y * k.y / (size * size);
  }
  float det = (1.0 + xx) * (1.0 + yy) - xy * xy;
  // Past its focus (det < 0) a ray is as spread as before it, but such spots are small: keep them bright.
  float gathered = 1.0 / (0.24 + max(det, 0.0));
  light = 0.72 * gathered * gathered;
}
