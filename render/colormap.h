// SPDX-License-Identifier: Apache-2.0
// Colors: maps for numbers and a palette for kinds, chosen so that color-blind people can distinguish them too.
#pragma once

#include <array>
#include <cstdint>
#include <string_view>
#include <vector>

namespace mercury::render {

// Gamma-encoded sRGB, as on a screen and in CSS.
struct Color {
  std::uint8_t r = 255, g = 255, b = 255, a = 255;
  friend constexpr bool operator==(const Color&, const Color&) = default;
};

// rgb(0x1f77b4)
constexpr Color rgb(std::uint32_t hex) {
  return {std::uint8_t(hex >> 16), std::uint8_t(hex >> 8), std::uint8_t(hex), 255};
}

// sRGB to linear light, 0 to 1 per channel (IEC 61966-2-1), and back, rounded.
std::array<float, 3> linear_of(Color color);
Color color_of_linear(std::array<float, 3> linear);

// The published maps without their darkest part, which would be invisible against dark water.
enum class Colormap {
  viridis,    // dark blue to yellow, even lightness steps: amounts
  magma,      // dark violet to cream, even lightness steps: amounts
  cividis,    // blue to yellow, even lightness steps: amounts, nearly the same without red or green cones
  turbo,      // rainbow with smooth lightness: shows small differences
  diverging,  // blue over gray to red: signed numbers, 0 in the middle
};

inline constexpr int colormap_count = 5;

// "viridis", "magma", "cividis", "turbo", "diverging".
std::string_view name_of(Colormap map);
// Throws std::invalid_argument that lists them.
Colormap colormap_named(std::string_view name);

// A perceptually even blend of two colors: t = 0 gives a, 1 gives b.
Color mix(Color a, Color b, float t);

// The color at t, clamped to [0, 1]; NaN gives mid-gray.
Color color_at(Colormap map, float t);

// The color for a value between low and high; low == high gives the middle.
Color color_at(Colormap map, float value, float low, float high);

// Perceptual color (Ottosson's Oklab in polar form): lightness 0 to 1, chroma 0 to about 0.3, hue in radians.
// Chroma is reduced until the color is inside sRGB.
Color oklch(float lightness, float chroma, float hue);

// A muscle's color: hue and lightness are its phase, with phases of 45 degrees and more apart for all kinds of color
// vision; slow ones are a little lighter. `phase` in radians, `speed` 0 = slowest to 1 = fastest.
Color muscle_color(float phase, float speed);
inline constexpr Color tissue_color = rgb(0xe9c9b4);
inline constexpr Color bone_color = rgb(0xf4f1e8);

// Colors for unordered things, such as lines in a plot; repeats after 10.
Color category_color(int index);

// Round numbers for a scale's ticks: at most `most` values from low to high, and the ends if they are round.
std::vector<float> ticks(float low, float high, int most = 6);

}  // namespace mercury::render
