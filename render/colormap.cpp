// SPDX-License-Identifier: Apache-2.0
#include "render/colormap.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <span>
#include <stdexcept>
#include <string>
#include <utility>

namespace mercury::render {
namespace {

constexpr std::array<std::pair<Colormap, std::string_view>, colormap_count> map_names{{
    {Colormap::viridis, "viridis"},
    {Colormap::magma, "magma"},
    {Colormap::cividis, "cividis"},
    {Colormap::turbo, "turbo"},
    {Colormap::diverging, "diverging"},
}};

// Evenly spaced samples of the published maps: viridis and magma (van der Walt and Smith, CC0), cividis (Nuñez,
// Anderton and Renslow 2018), turbo (Mikhailov).
constexpr std::array viridis{rgb(0x440154), rgb(0x482878), rgb(0x3e4989), rgb(0x31688e), rgb(0x26828e),
                             rgb(0x1f9e89), rgb(0x35b779), rgb(0x6ece58), rgb(0xb5de2b), rgb(0xfde725)};
constexpr std::array magma{rgb(0x000004), rgb(0x180f3d), rgb(0x440f76), rgb(0x721f81), rgb(0x9e2f7f),
                           rgb(0xcd4071), rgb(0xf1605d), rgb(0xfd9668), rgb(0xfeca8d), rgb(0xfcfdbf)};
constexpr std::array cividis{rgb(0x00224e), rgb(0x123570), rgb(0x3b496c), rgb(0x575d6d), rgb(0x707173),
                             rgb(0x8a8678), rgb(0xa59c74), rgb(0xc3b369), rgb(0xe1cc55), rgb(0xfee838)};
constexpr std::array turbo{rgb(0x30123b), rgb(0x4145ab), rgb(0x4675ed), rgb(0x39a2fc), rgb(0x1bcfd4),
                           rgb(0x24eca6), rgb(0x61fc6c), rgb(0xa4fc3b), rgb(0xd1e834), rgb(0xf3c63a),
                           rgb(0xfe9b2d), rgb(0xf36315), rgb(0xd93806), rgb(0xb11901), rgb(0x7a0402)};
constexpr std::array diverging{rgb(0x1d4ea3), rgb(0x4a83cc), rgb(0x8fb6e0), rgb(0xd9dde0),
                               rgb(0xecac8c), rgb(0xd26550), rgb(0xa31a2e)};

std::span<const Color> samples(Colormap map) {
  switch (map) {
    case Colormap::magma:
      return magma;
    case Colormap::cividis:
      return cividis;
    case Colormap::turbo:
      return turbo;
    case Colormap::diverging:
      return diverging;
    default:
      return viridis;
  }
}

// The share of a published map, from its dark end, that is left out.
float darkest(Colormap map) {
  switch (map) {
    case Colormap::viridis:
      return 0.1f;
    case Colormap::magma:
      return 0.22f;
    case Colormap::cividis:
      return 0.22f;
    case Colormap::turbo:
      return 0.05f;
    default:
      return 0;
  }
}

float decoded(std::uint8_t value) {
  const float x = float(value) / 255.0f;
  return x <= 0.04045f ? x / 12.92f : std::pow((x + 0.055f) / 1.055f, 2.4f);
}

std::uint8_t encoded(float x) {
  x = std::clamp(x, 0.0f, 1.0f);
  const float y = x <= 0.0031308f ? 12.92f * x : 1.055f * std::pow(x, 1.0f / 2.4f) - 0.055f;
  return std::uint8_t(std::lround(255.0f * y));
}

using Triple = std::array<float, 3>;

// Oklab (Ottosson 2020) to linear sRGB.
Triple linear_of_oklab(Triple lab) {
  const auto cube = [](float x) { return x * x * x; };
  const float l = cube(lab[0] + 0.3963377774f * lab[1] + 0.2158037573f * lab[2]);
  const float m = cube(lab[0] - 0.1055613458f * lab[1] - 0.0638541728f * lab[2]);
  const float s = cube(lab[0] - 0.0894841775f * lab[1] - 1.2914855480f * lab[2]);
  return {4.0767416621f * l - 3.3077115913f * m + 0.2309699292f * s,
          -1.2684380046f * l + 2.6097574011f * m - 0.3413193965f * s,
          -0.0041960863f * l - 0.7034186147f * m + 1.7076147010f * s};
}

Triple oklab_of_linear(Triple rgb) {
  const float l = std::cbrt(0.4122214708f * rgb[0] + 0.5363325363f * rgb[1] + 0.0514459929f * rgb[2]);
  const float m = std::cbrt(0.2119034982f * rgb[0] + 0.6806995451f * rgb[1] + 0.1073969566f * rgb[2]);
  const float s = std::cbrt(0.0883024619f * rgb[0] + 0.2817188376f * rgb[1] + 0.6299787005f * rgb[2]);
  return {0.2104542553f * l + 0.7936177850f * m - 0.0040720468f * s,
          1.9779984951f * l - 2.4285922050f * m + 0.4505937099f * s,
          0.0259040371f * l + 0.7827717662f * m - 0.8086757660f * s};
}

bool in_srgb(Triple linear) {
  return std::all_of(linear.begin(), linear.end(), [](float x) { return x >= -1e-4f && x <= 1.0001f; });
}

struct MuscleAnchor {
  float hue, lightness, chroma;
};
// An eighth of a turn apart in phase: terracotta, ochre, yellow, mint, teal, blue, violet, wine. Their chroma is at
// most 0.13. People who do not distinguish red from green see yellow, blue and lightness; this is a loop
// in these, too: bright yellow, bright and then dark blue, dark yellow. Found by a search for colors of this chroma
// with differences between phases at least 45 degrees apart of CIEDE2000 17 for normal vision, 13 without green or red
// cones.
constexpr std::array<MuscleAnchor, 8> muscle_anchors{{{0.746f, 0.524f, 0.130f},
                                                      {1.499f, 0.654f, 0.130f},
                                                      {1.956f, 0.863f, 0.130f},
                                                      {2.916f, 0.922f, 0.130f},
                                                      {3.512f, 0.726f, 0.088f},
                                                      {4.272f, 0.658f, 0.130f},
                                                      {5.031f, 0.423f, 0.108f},
                                                      {6.319f, 0.424f, 0.090f}}};

constexpr std::array categories{rgb(0x2f7ed8), rgb(0xf28e2b), rgb(0x1fa187), rgb(0xd1495b), rgb(0x9467bd),
                                rgb(0xe0b92f), rgb(0x56b4e9), rgb(0x8c6d46), rgb(0xe377c2), rgb(0x7f8fa6)};

}  // namespace

Triple linear_of(Color color) { return {decoded(color.r), decoded(color.g), decoded(color.b)}; }

Color color_of_linear(Triple linear) { return {encoded(linear[0]), encoded(linear[1]), encoded(linear[2]), 255}; }

std::string_view name_of(Colormap map) {
  for (const auto& [value, name] : map_names)
    if (value == map) return name;
  return "?";
}

Colormap colormap_named(std::string_view name) {
  for (const auto& [value, known] : map_names)
    if (known == name) return value;
  throw std::invalid_argument("'" + std::string(name) +
                              "' is not a color map; give viridis, magma, cividis, turbo or diverging");
}

Color mix(Color a, Color b, float t) {
  const Triple from = oklab_of_linear(linear_of(a)), to = oklab_of_linear(linear_of(b));
  Triple between;
  for (std::size_t i = 0; i < 3; ++i) between[i] = from[i] + t * (to[i] - from[i]);
  return color_of_linear(linear_of_oklab(between));
}

Color color_at(Colormap map, float t) {
  if (std::isnan(t)) return rgb(0x808080);
  const std::span<const Color> table = samples(map);
  const float first = darkest(map);
  const float position = (first + (1 - first) * std::clamp(t, 0.0f, 1.0f)) * float(table.size() - 1);
  const std::size_t index = std::min(std::size_t(position), table.size() - 2);
  return mix(table[index], table[index + 1], position - float(index));
}

Color color_at(Colormap map, float value, float low, float high) {
  return color_at(map, high == low ? 0.5f : (value - low) / (high - low));
}

Color oklch(float lightness, float chroma, float hue) {
  const auto at = [&](float c) { return linear_of_oklab({lightness, c * std::cos(hue), c * std::sin(hue)}); };
  if (in_srgb(at(chroma))) return color_of_linear(at(chroma));
  float inside = 0, outside = chroma;
  for (int i = 0; i < 12; ++i) {
    const float middle = 0.5f * (inside + outside);
    (in_srgb(at(middle)) ? inside : outside) = middle;
  }
  return color_of_linear(at(inside));
}

Color muscle_color(float phase, float speed) {
  constexpr std::size_t count = muscle_anchors.size();
  const float turns = phase / (2 * std::numbers::pi_v<float>), place = float(count) * (turns - std::floor(turns));
  const std::size_t index = std::size_t(place) % count;
  const float t = place - std::floor(place);
  const MuscleAnchor& a = muscle_anchors[index];
  const MuscleAnchor& b = muscle_anchors[(index + 1) % count];
  const float hue_step = b.hue - a.hue + (index + 1 == count ? 2 * std::numbers::pi_v<float> : 0.0f);
  const float lightness =
      a.lightness + t * (b.lightness - a.lightness) + 0.045f - 0.11f * std::clamp(speed, 0.0f, 1.0f);
  return oklch(lightness, a.chroma + t * (b.chroma - a.chroma), a.hue + t * hue_step);
}

Color category_color(int index) {
  const int count = int(categories.size());
  return categories[std::size_t(((index % count) + count) % count)];
}

std::vector<float> ticks(float low, float high, int most) {
  if (!(std::isfinite(low) && std::isfinite(high)) || !(high > low) || most < 2) return {low};
  const double span = double(high) - double(low);
  const double power = std::pow(10.0, std::floor(std::log10(span / most)));
  double step = power;
  for (const double factor : {1.0, 2.0, 2.5, 5.0, 10.0}) {
    step = factor * power;
    if (std::floor(high / step + 1e-6) - std::ceil(low / step - 1e-6) + 1 <= most) break;
  }
  std::vector<float> result;
  for (double i = std::ceil(low / step - 1e-6); i * step <= high + 1e-6 * step; ++i) result.push_back(float(i * step));
  return result;
}

}  // namespace mercury::render
