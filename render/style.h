// SPDX-License-Identifier: Apache-2.0
// Light and colors of each theme and surroundings.
#pragma once

#include "render/scene.h"
#include "render/vector.h"

namespace mercury::render {

// All colors of light are linear.
struct Style {
  Vector3 to_key{0.35f, -0.45f, 0.85f};  // direction toward the key light, any length
  Vector3 key_light, sky_light, ground_light;
  float key_size = 0.08f;               // tangent of the key light's half angle; larger = softer shadows
  Vector3 backdrop_high, backdrop_low;  // far away: level and above; straight down (on land straight up)
  Vector3 floor_color, line_color;
  Vector3 plant_low{0.02f, 0.05f, 0.03f}, plant_high{0.10f, 0.22f, 0.12f};  // at their feet and tips
  Vector3 stone{0.12f, 0.12f, 0.12f};
  Vector3 fog{0, 0, 0};  // extinction of each color [1 / distance from eye to target]
  float caustics = 0;    // contrast of the light pattern under water
  float glow = 1;        // of contracting muscles
  float vignette = 0.25f;
  Color text, text_edge;  // of labels and legends
  float text_edge_opacity = 0.85f;
};

// `values`: bodies are colored by values. Dark water is darker then, because the low ends of color maps are as dark.
Style style_of(Surroundings surroundings, Theme theme, bool values = false);
// The light of that style for pictures that look toward it: deep water with a bright surface; the last sun on land.
void set_against_light(Style& style, const KeyLight& light, Surroundings surroundings);

}  // namespace mercury::render
