// SPDX-License-Identifier: Apache-2.0
#include "render/style.h"

namespace mercury::render {
namespace {

constexpr float dimmed_water = 0.25f;  // of its light, behind values

Style dark_water() {
  Style s;
  s.to_key = {-0.34f, -0.22f, 0.92f};
  s.key_light = {2.35f, 2.35f, 2.20f};
  s.sky_light = {0.22f, 0.34f, 0.44f};
  s.ground_light = {0.09f, 0.13f, 0.16f};
  s.key_size = 0.10f;
  s.backdrop_high = {0.010f, 0.120f, 0.200f};
  s.backdrop_low = {0.003f, 0.034f, 0.070f};
  s.floor_color = {0.030f, 0.092f, 0.125f};
  s.fog = {0.70f, 0.50f, 0.44f};
  s.caustics = 0.55f;
  s.glow = 1.5f;
  s.vignette = 0.45f;
  s.plant_low = {0.008f, 0.040f, 0.045f};
  s.plant_high = {0.050f, 0.175f, 0.125f};
  s.stone = {0.050f, 0.085f, 0.100f};
  return s;
}

Style light_water() {
  Style s;
  s.to_key = {-0.34f, -0.22f, 0.92f};
  s.key_light = {2.55f, 2.40f, 2.15f};
  s.sky_light = {0.44f, 0.56f, 0.62f};
  s.ground_light = {0.28f, 0.31f, 0.29f};
  s.key_size = 0.10f;
  s.backdrop_high = {0.22f, 0.60f, 0.74f};
  s.backdrop_low = {0.08f, 0.38f, 0.54f};
  s.floor_color = {0.46f, 0.47f, 0.40f};
  s.fog = {0.70f, 0.38f, 0.32f};
  s.caustics = 0.40f;
  s.glow = 0.6f;
  s.vignette = 0.15f;
  s.plant_low = {0.06f, 0.16f, 0.13f};
  s.plant_high = {0.22f, 0.42f, 0.25f};
  s.stone = {0.26f, 0.29f, 0.28f};
  return s;
}

Style dark_plain() {
  Style s;
  s.to_key = {-0.50f, -0.28f, 0.82f};
  s.key_light = {2.45f, 2.35f, 2.20f};
  s.sky_light = {0.34f, 0.38f, 0.46f};
  s.ground_light = {0.10f, 0.10f, 0.10f};
  s.key_size = 0.06f;
  s.backdrop_high = {0.040f, 0.046f, 0.056f};
  s.backdrop_low = {0.040f, 0.046f, 0.056f};
  s.floor_color = {0.060f, 0.064f, 0.072f};
  s.line_color = {0.22f, 0.24f, 0.27f};
  s.fog = {0.22f, 0.22f, 0.22f};
  s.glow = 1.4f;
  s.vignette = 0.35f;
  return s;
}

Style light_plain() {
  Style s;
  s.to_key = {-0.50f, -0.28f, 0.82f};
  s.key_light = {2.30f, 2.22f, 2.10f};
  s.sky_light = {0.52f, 0.56f, 0.62f};
  s.ground_light = {0.22f, 0.21f, 0.20f};
  s.key_size = 0.06f;
  s.backdrop_high = {0.78f, 0.81f, 0.85f};
  s.backdrop_low = {0.78f, 0.81f, 0.85f};
  s.floor_color = {0.40f, 0.405f, 0.41f};
  s.line_color = {0.22f, 0.23f, 0.25f};
  s.fog = {0.22f, 0.22f, 0.22f};
  s.glow = 0.6f;
  s.vignette = 0.12f;
  return s;
}

// Evening: a low sun, long shadows, haze.
Style dark_land() {
  Style s = dark_plain();
  s.to_key = {-0.76f, -0.42f, 0.50f};
  s.key_light = {3.75f, 2.85f, 1.95f};
  s.sky_light = {0.27f, 0.34f, 0.50f};
  s.ground_light = {0.15f, 0.12f, 0.085f};
  s.key_size = 0.085f;
  s.backdrop_high = {0.345f, 0.255f, 0.200f};
  s.backdrop_low = {0.018f, 0.070f, 0.210f};
  s.floor_color = {0.150f, 0.122f, 0.088f};
  s.line_color = {0.26f, 0.26f, 0.25f};
  s.fog = {0.10f, 0.11f, 0.13f};
  s.plant_low = {0.075f, 0.070f, 0.034f};
  s.plant_high = {0.270f, 0.225f, 0.095f};
  s.stone = {0.190f, 0.160f, 0.130f};
  return s;
}

Style light_land() {
  Style s = light_plain();
  s.to_key = {-0.72f, -0.40f, 0.66f};
  s.key_light = {2.75f, 2.52f, 2.18f};
  s.sky_light = {0.46f, 0.53f, 0.62f};
  s.ground_light = {0.24f, 0.22f, 0.19f};
  s.key_size = 0.085f;
  s.backdrop_high = {0.74f, 0.80f, 0.86f};
  s.backdrop_low = {0.16f, 0.36f, 0.68f};
  s.floor_color = {0.45f, 0.41f, 0.335f};
  s.line_color = {0.20f, 0.19f, 0.17f};
  s.fog = {0.10f, 0.11f, 0.13f};
  s.plant_low = {0.17f, 0.19f, 0.09f};
  s.plant_high = {0.40f, 0.42f, 0.19f};
  s.stone = {0.36f, 0.34f, 0.31f};
  return s;
}

}  // namespace

Style style_of(Surroundings surroundings, Theme theme, bool values) {
  const bool dark = theme == Theme::dark;
  Style s = dark ? dark_plain() : light_plain();
  if (surroundings == Surroundings::water) s = dark ? dark_water() : light_water();
  if (surroundings == Surroundings::land) s = dark ? dark_land() : light_land();
  if (surroundings == Surroundings::none) s.fog = {};
  if (values && dark && surroundings == Surroundings::water) {
    s.backdrop_high *= dimmed_water;
    s.backdrop_low *= dimmed_water;
    s.floor_color *= dimmed_water;
    s.plant_low *= dimmed_water;
    s.plant_high *= dimmed_water;
    s.stone *= dimmed_water;
  }
  s.text = dark ? rgb(0xf2f6f8) : rgb(0x16232c);
  s.text_edge_opacity = dark ? 0.85f : 0.0f;
  s.text_edge = dark ? rgb(0x04121c) : rgb(0xffffff);
  return s;
}

void set_against_light(Style& s, const KeyLight& light, Surroundings surroundings) {
  s.to_key = light.to_key;
  if (surroundings == Surroundings::water) {
    s.key_light = {4.6f, 4.5f, 4.0f};
    s.sky_light = {0.30f, 0.46f, 0.54f};
    s.ground_light = {0.14f, 0.24f, 0.30f};
    s.backdrop_high = {0.012f, 0.150f, 0.235f};
    s.backdrop_low = {0.002f, 0.020f, 0.050f};
    s.fog = {0.42f, 0.24f, 0.20f};
  } else {
    s.key_light = {4.9f, 3.05f, 1.55f};
    s.sky_light = {0.22f, 0.27f, 0.40f};
    s.ground_light = {0.16f, 0.12f, 0.08f};
    s.floor_color = {0.30f, 0.225f, 0.150f};
    s.plant_low = {0.11f, 0.085f, 0.040f};
    s.plant_high = {0.34f, 0.245f, 0.090f};
    s.stone = {0.20f, 0.155f, 0.115f};
    s.backdrop_high = {0.52f, 0.31f, 0.18f};
    s.backdrop_low = {0.030f, 0.080f, 0.230f};
    s.fog = {0.045f, 0.050f, 0.058f};
  }
}

}  // namespace mercury::render
