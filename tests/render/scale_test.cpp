// SPDX-License-Identifier: Apache-2.0
#include "render/text/scale.h"

#include <gtest/gtest.h>
#include <Eigen/Core>

#include <cmath>
#include <vector>

#include "render/style.h"
#include "tests/render/triangle.h"

namespace mercury::render {
namespace {

TEST(Scale, LinearPositionsAreShares) {
  const Scale scale{.low = 2, .high = 6};
  EXPECT_FLOAT_EQ(position_on(scale, 2), 0);
  EXPECT_FLOAT_EQ(position_on(scale, 3), 0.25f);
  EXPECT_FLOAT_EQ(position_on(scale, 10), 2);
  EXPECT_FLOAT_EQ(position_on({.low = 3, .high = 3}, 7), 0.5f);
  EXPECT_TRUE(std::isnan(position_on(scale, NAN)));
  EXPECT_EQ(color_on(scale, 4), color_at(scale.map, 0.5f));
}

TEST(Scale, LogarithmicPositionsDependOnRatios) {
  const Scale scale{.low = 0.01f, .high = 100, .logarithmic = true};
  EXPECT_NEAR(position_on(scale, 1), 0.5f, 1e-6f);
  EXPECT_NEAR(position_on(scale, 0.1f), 0.25f, 1e-6f);
  EXPECT_LT(position_on(scale, 0), -1) << "what has no logarithm is below the low end";
  EXPECT_LT(position_on(scale, -5), -1);
}

// asinh(x) = ln(x + sqrt(x^2 + 1)), which is x near 0 and ln(2 x) far from it.
TEST(Scale, LogarithmicScalesAroundZeroAreEvenNearIt) {
  const Scale scale{.low = -10, .high = 10, .logarithmic = true};
  EXPECT_FLOAT_EQ(position_on(scale, 0), 0.5f);
  for (const float x : {0.01f, 0.5f, 3.0f, 10.0f}) {
    const double end = std::log(100 + std::sqrt(1e4 + 1)), at = std::log(x / 0.1 + std::sqrt(x * x / 0.01 + 1));
    EXPECT_NEAR(position_on(scale, x), 0.5 + 0.5 * at / end, 1e-5) << x;
    EXPECT_NEAR(position_on(scale, x) + position_on(scale, -x), 1, 1e-5) << x;
  }
}

TEST(Scale, ValuesAndPositionsAreInverse) {
  for (const Scale& scale : {Scale{.low = -3, .high = 8}, Scale{.low = 0.2f, .high = 30, .logarithmic = true},
                             Scale{.low = -3, .high = 8, .logarithmic = true}})
    for (const float position : {-0.2f, 0.0f, 0.3f, 1.0f, 1.4f})
      EXPECT_NEAR(position_on(scale, value_on(scale, position)), position, 1e-4);
}

TEST(Scale, TicksAreRoundAndWhereTheirValuesAre) {
  for (const Scale& scale :
       {Scale{.low = 0, .high = 0.37f}, Scale{.low = 0.0004f, .high = 7, .logarithmic = true},
        Scale{.low = 21, .high = 47, .logarithmic = true}, Scale{.low = -10, .high = 10, .logarithmic = true},
        Scale{.low = 1e-12f, .high = 1e9f, .logarithmic = true}}) {
    const std::vector<Tick> ticks = ticks_of(scale);
    ASSERT_GE(ticks.size(), 2u) << scale.low;
    EXPECT_LE(ticks.size(), 9u) << scale.low;
    for (const Tick& tick : ticks) {
      EXPECT_GE(tick.position, -0.01f);
      EXPECT_LE(tick.position, 1.01f);
      if (tick.text.starts_with("\u2212")) continue;  // not a minus sign for stof()
      EXPECT_NEAR(position_on(scale, std::stof(tick.text)), tick.position, 1e-3) << tick.text;
    }
  }
}

class ScaleOnBodies : public Offscreen {};

// A face whose value has the color that the legend shows for it, on every kind of scale.
TEST_F(ScaleOnBodies, ShadersAndLegendsAgree) {
  Renderer renderer = make_renderer();
  const Mesh mesh = triangle();
  renderer.set_bodies(std::array{mesh.body()});
  for (const Scale& scale : {Scale{.low = 1, .high = 9, .map = Colormap::turbo},
                             Scale{0.01f, 100, Colormap::turbo, true}, Scale{-5, 20, Colormap::turbo, true}}) {
    for (const float position : {0.1f, 0.4f, 0.55f, 0.8f}) {
      const std::array<float, 1> value{value_on(scale, position)}, same{position};
      Scene scene = plain();
      scene.scale = scale;
      scene.face_values = value;
      const Image with_scale = drawn(renderer, scene);
      scene.scale = {.low = 0, .high = 1, .map = Colormap::turbo};
      scene.face_values = same;
      EXPECT_LE(count_differing(with_scale, drawn(renderer, scene), 3), 0) << position;
    }
  }
}

// Oklab of linear light (Ottosson 2020).
Eigen::Vector3f oklab(const Vector3& linear) {
  const Eigen::Vector3f rgb(linear.x, linear.y, linear.z);
  Eigen::Matrix3f to_cones, to_lab;
  to_cones << 0.4122214708f, 0.5363325363f, 0.0514459929f, 0.2119034982f, 0.6806995451f, 0.1073969566f, 0.0883024619f,
      0.2817188376f, 0.6299787005f;
  to_lab << 0.2104542553f, 0.7936177850f, -0.0040720468f, 1.9779984951f, -2.4285922050f, 0.4505937099f, 0.0259040371f,
      0.7827717662f, -0.8086757660f;
  return to_lab * (to_cones * rgb).array().unaryExpr([](float x) { return std::cbrt(x); }).matrix();
}

// A difference of 0.02 is just visible.
TEST(Scale, LowEndsOfMapsDifferFromWater) {
  for (const Theme theme : {Theme::dark, Theme::light})
    for (int map = 0; map < colormap_count; ++map) {
      const Style style = style_of(Surroundings::water, theme, true);
      for (const float position : {0.0f, 0.05f, 0.1f}) {
        const auto low = linear_of(color_at(Colormap(map), position));
        for (const Vector3& water : {style.backdrop_high, style.backdrop_low})
          EXPECT_GT((oklab({low[0], low[1], low[2]}) - oklab(water)).norm(), 0.12f)
              << name_of(Colormap(map)) << " " << position << " " << int(theme);
      }
    }
}

}  // namespace
}  // namespace mercury::render
