// SPDX-License-Identifier: Apache-2.0
// Which values the ends of a color map stand for.
#include "app/scene/color_scale.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <vector>

#include "app/scene/color_quantity.h"
#include "app/scene/group_scene.h"
#include "mercury/random_voxel.h"
#include "mercury/simulation.h"

namespace mercury::test {
namespace {

ViewSettings colored_by(const char* quantity) {
  ViewSettings settings;
  settings.color = &color_quantity(quantity);
  return settings;
}

// 0, 1, ..., 100 times a factor: the percentiles are known.
std::vector<float> hundred(float factor) {
  std::vector<float> values(101);
  for (std::size_t i = 0; i < values.size(); ++i) values[i] = factor * static_cast<float>((37 * i) % 101);
  return values;
}

TEST(ColorScale, ReachesFromTheSecondToTheNinetyEighthPercentile) {
  ColorScale scale(colored_by("speed"));
  scale.fit(0, hundred(0.5f), true);
  EXPECT_FLOAT_EQ(scale.scale().low, 1);
  EXPECT_FLOAT_EQ(scale.scale().high, 49);
  EXPECT_EQ(scale.legend().unit, "m/s");
}

TEST(ColorScale, OfSignedQuantitiesReachesAsFarToBothSides) {
  ColorScale scale(colored_by("force"));
  std::vector<float> values = hundred(1);
  for (float& value : values) value -= 70;
  scale.fit(0, values, true);
  EXPECT_FLOAT_EQ(scale.scale().low, -68);
  EXPECT_FLOAT_EQ(scale.scale().high, 68);
}

TEST(ColorScale, IsNotWidenedByAFewExtremes) {
  ColorScale scale(colored_by("energy"));
  std::vector<float> values = hundred(1);
  values.front() = 1e9f;
  values.back() = INFINITY;
  scale.fit(0, values, true);
  EXPECT_LE(scale.scale().high, 100);
}

TEST(ColorScale, GrowsAtOnceAndShrinksAgainAfterOneSlowestPeriod) {
  ColorScale scale(colored_by("speed"));
  scale.fit(0, hundred(1), true);
  scale.fit(0.1, hundred(10), false);
  EXPECT_FLOAT_EQ(scale.scale().high, 980);
  double time = 0.1;
  for (; time < 6.2; time += 0.1) scale.fit(time, hundred(1), false);
  EXPECT_FLOAT_EQ(scale.scale().high, 980) << "a muscle of 1 rad/s may repeat it";
  float last = scale.scale().high;
  for (; time < 12; time += 0.1) {
    scale.fit(time, hundred(1), false);
    EXPECT_LE(scale.scale().high, last);
    EXPECT_GT(scale.scale().high, 0.7f * last) << "smoothly";
    last = scale.scale().high;
  }
  EXPECT_NEAR(last, 98, 1);
}

TEST(ColorScale, RestsWhileAMotionRepeats) {
  ColorScale scale(colored_by("speed"));
  const auto at = [&](double time) { scale.fit(time, hundred(1 + 0.8f * std::sin(static_cast<float>(time))), false); };
  double time = 0;
  for (; time < 7; time += 1.0 / 30) at(time);
  const render::Scale settled = scale.scale();
  for (; time < 20; time += 1.0 / 30) {
    at(time);
    EXPECT_NEAR(scale.scale().high, settled.high, 0.01f * settled.high);
    EXPECT_NEAR(scale.scale().low, settled.low, 0.01f * settled.high);
  }
}

TEST(ColorScale, DependsOnSimulatedTimeAlone) {
  const auto film = [](int repeats) {
    ColorScale scale(colored_by("speed"));
    std::vector<float> ends;
    for (int frame = 0; frame < 400; ++frame) {
      // A window may show the same state several times.
      for (int i = 0; i < repeats; ++i)
        scale.fit(0.05 * frame, hundred(1 + 100 / (1 + static_cast<float>(frame * frame))), false);
      ends.push_back(scale.scale().high);
    }
    return ends;
  };
  EXPECT_EQ(film(1), film(3));
}

TEST(ColorScale, StartsAgainWithOtherRobotsOrAnEarlierTime) {
  ColorScale scale(colored_by("speed"));
  scale.fit(5, hundred(10), true);
  scale.fit(5, hundred(1), true);
  EXPECT_FLOAT_EQ(scale.scale().high, 98);
  scale.fit(4, hundred(0.1f), false);
  EXPECT_FLOAT_EQ(scale.scale().high, 9.8f);
}

TEST(ColorScale, KeepsAScaleThatTheUserGives) {
  ViewSettings settings = colored_by("speed");
  settings.scale = {0.5f, 2.0f};
  settings.colormap = render::Colormap::magma;
  ColorScale scale(settings);
  scale.fit(0, {100, 1, 0.1f}, true);
  EXPECT_EQ(scale.scale().low, 0.5f);
  EXPECT_EQ(scale.scale().high, 2.0f);
  EXPECT_EQ(scale.scale().map, render::Colormap::magma);
}

TEST(ColorScale, OfOneValueStartsAtZero) {
  ColorScale scale(colored_by("stiffness"));
  scale.fit(0, std::vector<float>(50, 80.0f), true);
  EXPECT_EQ(scale.scale().low, 0);
  EXPECT_EQ(scale.scale().high, 80);
}

TEST(ColorScale, LogarithmicOfAmountsStaysAboveZero) {
  ViewSettings settings = colored_by("energy");
  settings.log_scale = true;
  ColorScale scale(settings);
  scale.fit(0, {0, 0, 0, 1e-9f, 3, 5, 5}, true);
  EXPECT_GT(scale.scale().low, 0);
  EXPECT_LE(scale.scale().high / scale.scale().low, 1.001e4f);
}

TEST(ColorScale, HistogramCountsValuesOnTheScale) {
  ViewSettings settings = colored_by("speed");
  settings.scale = {0.0f, 32.0f};
  ColorScale scale(settings);
  scale.fit(0, {0.5f, 0.5f, 0.5f, 0.5f, 10.5f, 99, NAN}, true);
  const std::vector<float> histogram = scale.legend().histogram;
  ASSERT_EQ(histogram.size(), 32u);
  EXPECT_FLOAT_EQ(histogram[0], 1);      // 4 values: the most
  EXPECT_FLOAT_EQ(histogram[10], 0.5f);  // 1 value: sqrt(1 / 4)
  EXPECT_FLOAT_EQ(histogram[31], 0.5f);  // beyond the end, in its color
  EXPECT_FLOAT_EQ(std::accumulate(histogram.begin(), histogram.end(), 0.0f), 2);
}

TEST(Sample, TakesEveryElementOfTheRangesOrEvenlySpreadOnes) {
  std::vector<float> values(200'000);
  std::iota(values.begin(), values.end(), 0.0f);
  EXPECT_EQ(sample(values, std::vector<ValueRange>{{2, 2}, {7, 1}}), (std::vector<float>{2, 3, 7}));
  EXPECT_TRUE(sample(values, {}).empty());
  const std::vector<ValueRange> two{{0, 50'000}, {150'000, 50'000}};
  const std::vector<float> some = sample(values, two);
  EXPECT_EQ(some, sample(values, two));
  EXPECT_TRUE(std::ranges::is_sorted(some));
  EXPECT_TRUE(std::ranges::none_of(some, [](float value) { return value >= 50'000 && value < 150'000; }));
  EXPECT_NEAR(some[some.size() / 4], 25'000, 100);
  EXPECT_NEAR(some[3 * some.size() / 4], 175'000, 100);
}

// Hidden and exploded robots do not count.
TEST(GroupScene, TheScaleFitsRobotsThatAreVisible) {
  const Simulation simulation(Configuration{.device = {.kind = DeviceKind::cpu}},
                              std::vector<Robot>{random_voxel_robot({}, 1), random_voxel_robot({}, 2)});
  GroupScene scene(simulation, {{0, 0, 0}, {5, 0, 0}}, colored_by("speed"));
  const std::size_t first = simulation.robot(0).masses.size(), second = simulation.robot(1).masses.size();
  std::vector<Telemetry> telemetry = simulation.telemetry();
  const auto high = [&](double time) {
    SceneDetails details;
    details.values.mass.assign(first, 1);
    details.values.mass.resize(first + second, 100);
    scene.update(time, telemetry, details);
    return scene.scene().scale.high;
  };
  EXPECT_EQ(high(1), 100);
  scene.mark(1, false, true);
  EXPECT_EQ(high(1), 1);
  scene.mark(1, true, false);
  EXPECT_EQ(high(1), 100);
  scene.mark(1, false, false);
  const render::Vector3 middle = scene.bounds()[0].center();
  scene.see({.eye = middle - render::Vector3(0, 3, 0), .target = middle}, 1);
  EXPECT_EQ(high(1.01), 1) << "the second robot is outside the view";
  ViewSettings settings = colored_by("speed");
  settings.scale_all = true;
  scene.set_settings(settings);
  EXPECT_EQ(high(1.03), 100);
  telemetry[1].exploded = true;
  EXPECT_EQ(high(1.04), 1);
}

}  // namespace
}  // namespace mercury::test
