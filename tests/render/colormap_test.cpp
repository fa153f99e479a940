// SPDX-License-Identifier: Apache-2.0
#include "render/colormap.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace mercury::render {
namespace {

// CIE lightness from linear sRGB's luminance.
float lightness(Color color) {
  const auto c = linear_of(color);
  const float y = 0.2126f * c[0] + 0.7152f * c[1] + 0.0722f * c[2];
  return y > 0.008856f ? 116 * std::cbrt(y) - 16 : 903.3f * y;
}

std::array<float, 3> lab(std::array<float, 3> c) {
  const auto f = [](float t) { return t > 0.008856f ? std::cbrt(t) : 7.787f * t + 16.0f / 116; };
  const float x = f((0.4124f * c[0] + 0.3576f * c[1] + 0.1805f * c[2]) / 0.9505f);
  const float y = f(0.2126f * c[0] + 0.7152f * c[1] + 0.0722f * c[2]);
  const float z = f((0.0193f * c[0] + 0.1192f * c[1] + 0.9505f * c[2]) / 1.089f);
  return {116 * y - 16, 500 * (x - y), 200 * (y - z)};
}

// The difference CIEDE2000 of two colors in Lab (Sharma, Wu and Dalal 2005).
double ciede2000(std::array<float, 3> first, std::array<float, 3> second) {
  constexpr double degree = std::numbers::pi / 180;
  const auto power7 = [](double x) { return std::pow(x, 7); };
  const double mean_chroma = (std::hypot(first[1], first[2]) + std::hypot(second[1], second[2])) / 2;
  const double g = 0.5 * (1 - std::sqrt(power7(mean_chroma) / (power7(mean_chroma) + power7(25))));
  const double a1 = (1 + g) * first[1], a2 = (1 + g) * second[1];
  const double c1 = std::hypot(a1, first[2]), c2 = std::hypot(a2, second[2]);
  const auto hue = [&](double a, double b) { return std::fmod(std::atan2(b, a) / degree + 360, 360); };
  const double h1 = hue(a1, first[2]), h2 = hue(a2, second[2]);
  double dh = h2 - h1;
  if (dh > 180) dh -= 360;
  if (dh < -180) dh += 360;
  const double dl = second[0] - first[0], dc = c2 - c1, dbig = 2 * std::sqrt(c1 * c2) * std::sin(dh / 2 * degree);
  const double l = (first[0] + second[0]) / 2, c = (c1 + c2) / 2;
  double h = (h1 + h2) / 2;
  if (std::abs(h1 - h2) > 180) h += h1 + h2 < 360 ? 180 : -180;
  const double t = 1 - 0.17 * std::cos((h - 30) * degree) + 0.24 * std::cos(2 * h * degree) +
                   0.32 * std::cos((3 * h + 6) * degree) - 0.2 * std::cos((4 * h - 63) * degree);
  const double turn = 30 * std::exp(-std::pow((h - 275) / 25, 2)),
               rc = 2 * std::sqrt(power7(c) / (power7(c) + power7(25)));
  const double sl = 1 + 0.015 * std::pow(l - 50, 2) / std::sqrt(20 + std::pow(l - 50, 2)), sc = 1 + 0.045 * c,
               sh = 1 + 0.015 * c * t;
  return std::sqrt(std::pow(dl / sl, 2) + std::pow(dc / sc, 2) + std::pow(dbig / sh, 2) -
                   std::sin(2 * turn * degree) * rc * dc / sc * dbig / sh);
}

// Pairs of Sharma, Wu and Dalal's table.
TEST(Ciede2000, IsThePublishedOne) {
  EXPECT_NEAR(ciede2000({50, 2.6772f, -79.7751f}, {50, 0, -82.7485f}), 2.0425, 1e-3);
  EXPECT_NEAR(ciede2000({50, 2.5f, 0}, {61, -5, 29}), 22.8977, 1e-3);
  EXPECT_NEAR(ciede2000({2.0776f, 0.0795f, -1.1350f}, {0.9033f, -0.0636f, -0.5514f}), 0.9082, 1e-3);
}

// Colors for people without long-wave cones (Machado, Oliveira and Fernandes 2009, severity 1).
std::array<float, 3> protanope(Color color) {
  const auto c = linear_of(color);
  return {std::max(0.0f, 0.152286f * c[0] + 1.052583f * c[1] - 0.204868f * c[2]),
          std::max(0.0f, 0.114503f * c[0] + 0.786281f * c[1] + 0.099216f * c[2]),
          std::max(0.0f, -0.003882f * c[0] - 0.048116f * c[1] + 1.051998f * c[2])};
}

// Colors for people without medium-wave cones, likewise.
std::array<float, 3> deuteranope(Color color) {
  const auto c = linear_of(color);
  return {std::max(0.0f, 0.367322f * c[0] + 0.860646f * c[1] - 0.227968f * c[2]),
          std::max(0.0f, 0.280085f * c[0] + 0.672501f * c[1] + 0.047413f * c[2]),
          std::max(0.0f, -0.011820f * c[0] + 0.042940f * c[1] + 0.968881f * c[2])};
}

float distance(std::array<float, 3> a, std::array<float, 3> b) {
  return std::hypot(a[0] - b[0], a[1] - b[1], a[2] - b[2]);
}

TEST(Color, LinearLightRoundTripsEveryCode) {
  for (int i = 0; i < 256; ++i) {
    const Color gray{std::uint8_t(i), std::uint8_t(i), std::uint8_t(i), 255};
    EXPECT_EQ(color_of_linear(linear_of(gray)), gray);
  }
  EXPECT_NEAR(linear_of(rgb(0xbcbcbc))[0], 0.5f, 0.005f);  // half of the light in sRGB
}

// From its tenth percent on: what is darker is left out.
TEST(Colormap, ViridisIsThePublishedOneWithoutItsDarkEnd) {
  const Color low = color_at(Colormap::viridis, 0);  // published as (72, 36, 117)
  EXPECT_NEAR(low.r, 72, 4);
  EXPECT_NEAR(low.g, 36, 4);
  EXPECT_NEAR(low.b, 117, 4);
  EXPECT_EQ(color_at(Colormap::viridis, 1), rgb(0xfde725));
  const Color middle = color_at(Colormap::viridis, 0.4f / 0.9f);  // published as (33, 145, 140)
  EXPECT_NEAR(middle.r, 33, 4);
  EXPECT_NEAR(middle.g, 145, 4);
  EXPECT_NEAR(middle.b, 140, 4);
}

TEST(Colormap, MapsForAmountsGetLighterMonotonically) {
  for (const Colormap map : {Colormap::viridis, Colormap::magma, Colormap::cividis})
    for (int i = 1; i <= 64; ++i)
      EXPECT_GT(lightness(color_at(map, float(i) / 64)), lightness(color_at(map, float(i - 1) / 64)) - 0.1f);
}

TEST(Colormap, DivergingIsGrayInTheMiddleAndEquallyDarkAtBothEnds) {
  const auto middle = lab(linear_of(color_at(Colormap::diverging, 0.5f)));
  EXPECT_LT(std::hypot(middle[1], middle[2]), 4);
  EXPECT_NEAR(lightness(color_at(Colormap::diverging, 0)), lightness(color_at(Colormap::diverging, 1)), 4);
}

TEST(Colormap, ClampsAndAcceptsOddScales) {
  EXPECT_EQ(color_at(Colormap::turbo, 7.0f, 0, 1), color_at(Colormap::turbo, 1));
  EXPECT_EQ(color_at(Colormap::turbo, -7.0f, 0, 1), color_at(Colormap::turbo, 0));
  EXPECT_EQ(color_at(Colormap::turbo, 3.0f, 3, 3), color_at(Colormap::turbo, 0.5f));
  EXPECT_EQ(color_at(Colormap::turbo, 1.0f, 3, 1), color_at(Colormap::turbo, 1));  // high below low runs backward
  EXPECT_EQ(color_at(Colormap::turbo, std::nanf("")), rgb(0x808080));
}

TEST(Colormap, NamesRoundTrip) {
  for (int i = 0; i < colormap_count; ++i) EXPECT_EQ(colormap_named(name_of(Colormap(i))), Colormap(i));
  EXPECT_THROW(colormap_named("jet"), std::invalid_argument);
}

TEST(MuscleColor, PhasesDifferWithAndWithoutGreenCones) {
  for (int a = 0; a < 4; ++a)
    for (int b = 0; b < a; ++b) {
      const Color first = muscle_color(float(a) * std::numbers::pi_v<float> / 2, 0.5f),
                  second = muscle_color(float(b) * std::numbers::pi_v<float> / 2, 0.5f);
      EXPECT_GT(distance(lab(linear_of(first)), lab(linear_of(second))), 30);
      EXPECT_GT(distance(lab(deuteranope(first)), lab(deuteranope(second))), 14);
    }
}

// Also phases in between: every 15 degrees, all pairs that are 45 degrees apart or more.
TEST(MuscleColor, PhasesAnEighthOfATurnApartDifferForAllKindsOfColorVision) {
  using Vision = std::array<float, 3> (*)(Color);
  const auto difference = [](Vision seen, int a, int b, float speed) {
    const auto at = [&](int degrees) {
      return lab(seen(muscle_color(float(degrees) * std::numbers::pi_v<float> / 180, speed)));
    };
    return ciede2000(at(a), at(b));
  };
  for (const float speed : {0.0f, 0.5f, 1.0f})
    for (int a = 0; a < 360; a += 15)
      for (int b = a + 45; b <= a + 180; b += 15) {
        EXPECT_GT(difference(linear_of, a, b, speed), 17) << a << ' ' << b << ' ' << speed;
        EXPECT_GT(difference(deuteranope, a, b, speed), 13) << a << ' ' << b << ' ' << speed;
        EXPECT_GT(difference(protanope, a, b, speed), 13) << a << ' ' << b << ' ' << speed;
      }
}

TEST(MuscleColor, FasterIsDarker) {
  for (int phase = 0; phase < 4; ++phase)
    EXPECT_GT(lightness(muscle_color(float(phase) * std::numbers::pi_v<float> / 2, 0)),
              lightness(muscle_color(float(phase) * std::numbers::pi_v<float> / 2, 1)) + 8);
}

TEST(MuscleColor, HueTurnsWithThePhase) {
  EXPECT_EQ(muscle_color(0.3f, 0.5f), muscle_color(0.3f + 2 * std::numbers::pi_v<float>, 0.5f));
  EXPECT_EQ(muscle_color(-std::numbers::pi_v<float> / 2, 0.5f), muscle_color(3 * std::numbers::pi_v<float> / 2, 0.5f));
}

TEST(Oklch, StaysInsideSrgb) {
  const Color strong = oklch(0.6f, 0.5f, 2.5f);  // beyond any screen
  EXPECT_NEAR(lightness(strong), lightness(oklch(0.6f, 0.05f, 2.5f)), 6);
}

TEST(Ticks, AreRoundAndInside) {
  EXPECT_EQ(ticks(0, 1, 6), (std::vector<float>{0, 0.2f, 0.4f, 0.6f, 0.8f, 1}));
  EXPECT_EQ(ticks(-0.13f, 0.11f, 3), (std::vector<float>{-0.1f, 0, 0.1f}));
  EXPECT_EQ(ticks(5, 5), std::vector<float>{5});
  for (const float tick : ticks(13, 97)) {
    EXPECT_GE(tick, 13);
    EXPECT_LE(tick, 97);
  }
}

}  // namespace
}  // namespace mercury::render
