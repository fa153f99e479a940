// One tile of caustics: how strongly a surface of a few waves gathers light, 1 / |det of the map of its rays|.
#include "frame.glsl"
layout(location = 0) in vec2 place;
layout(location = 0) out float light;

void main() {
  const int waves = 11;
  // Whole numbers of waves a tile, so that it repeats without a seam.
  const vec2 vectors[waves] = vec2[](vec2(1, 2), vec2(2, -1), vec2(-2, 2), vec2(3, 1), vec2(-1, -3), vec2(3, -3),
                                     vec2(-4, 1), vec2(1, 5), vec2(5, 2), vec2(-3, 5), vec2(-5, -4));
  float xx = 0.0, xy = 0.0, yy = 0.0;
  for (int i = 0; i < waves; ++i) {
    vec2 k = vectors[i];
    float speed = 1.1 * sqrt(length(k));  // deep water: longer waves run faster
    float wave = sin(6.2831853 * dot(k, place) - speed * frame.eye.w + 1.7 * float(i * i));
    float bend = 0.42 * wave / pow(length(k), 0.35);
    xx += bend * k.x * k.x / dot(k, k);
    xy += bend * k.x * k.y / dot(k, k);
    yy += bend * k.y * k.y / dot(k, k);
  }
  float gathered = abs((1.0 + xx) * (1.0 + yy) - xy * xy);
  light = min(1.0, 0.25 * 0.62 / max(gathered, 0.12));
}
