// SPDX-License-Identifier: Apache-2.0
// The path of a robot, and the part of it that is shown behind a robot in its cell.
#include "app/scene/trail.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace mercury {
namespace {

// Along x, one point per `step`.
Trail straight(int count, float step) {
  Trail trail({0, 0, 0});
  for (int i = 0; i <= count; ++i) {
    trail.pass({step * static_cast<float>(i), 0, 0});
    trail.lengthen(0.5f * step);
  }
  return trail;
}

TEST(Trail, ALongPathKeepsItsBeginningAndItsLength) {
  const Trail trail = straight(20'000, 0.1f);
  EXPECT_LE(trail.lengths().size(), Trail::most_points);
  EXPECT_EQ(trail.points()[0], 0);
  EXPECT_NEAR(trail.lengths().back(), 2000, 1);
  EXPECT_EQ(trail.points().size(), 3 * trail.lengths().size());
  for (std::size_t i = 1; i < trail.lengths().size(); ++i) EXPECT_GT(trail.lengths()[i], trail.lengths()[i - 1]);
}

TEST(Trail, AStepBelowTheLeastAddsNoPoint) {
  Trail trail({0, 0, 0});
  trail.lengthen(0.1f);
  trail.pass({0.05f, 0, 0});
  trail.lengthen(0.1f);
  EXPECT_EQ(trail.lengths().size(), 1u);
}

TEST(Trail, PlacesThatAreNotFiniteAreIgnored) {
  Trail trail({1, 2, 3});
  trail.pass({std::numeric_limits<float>::quiet_NaN(), 0, 0});
  trail.pass({0, std::numeric_limits<float>::infinity(), 0});
  EXPECT_EQ(trail.last(), (Vec3{1, 2, 3}));
}

TEST(Trail, TheWakeEndsWhereThePathLeavesItsReach) {
  const Trail trail = straight(100, 0.1f);
  const auto wake = trail.wake(2.05f);
  ASSERT_EQ(wake.size(), 3 * 21u);
  EXPECT_NEAR(wake[0], 8, 1e-4);
  EXPECT_NEAR(wake[wake.size() - 3], 10, 1e-4);
}

TEST(Trail, MarksStandAtMultiplesOfTheirDistanceAcrossThePath) {
  const Trail trail = straight(100, 0.13f);  // to 13 m
  const std::vector<float> bars = marks_of(trail, trail.wake(4.5f), 2, 0.5f);
  // At 10 and 12 m, two bars each.
  ASSERT_EQ(bars.size(), 2 * 2 * 6u);
  for (std::size_t bar = 0; bar < bars.size(); bar += 6) {
    const float* a = &bars[bar];
    const float* b = &bars[bar + 3];
    EXPECT_NEAR(a[0], bar < 12 ? 10 : 12, 1e-3);
    EXPECT_NEAR(a[0], b[0], 1e-5) << "across the path";
    EXPECT_NEAR(std::hypot(b[1] - a[1], b[2] - a[2]), 0.5, 1e-5);
  }
}

}  // namespace
}  // namespace mercury
