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
    trail.lengthen(0.5f * step, i);
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
  trail.lengthen(0.1f, 0);
  trail.pass({0.05f, 0, 0});
  trail.lengthen(0.1f, 1);
  EXPECT_EQ(trail.lengths().size(), 1u);
}

// Of a robot that is at x = time.
void move_to(Trail& trail, double time, Later later) {
  trail.pass({static_cast<float>(time), 0, 0});
  trail.lengthen(0.5f, time, later);
}

TEST(Trail, EndsAtAnEarlierMomentAndIsThereAgainLater) {
  Trail trail = straight(10, 1);
  move_to(trail, 4.3, Later::skip);
  EXPECT_EQ(trail.lengths().back(), 4);
  EXPECT_EQ(trail.points().size(), 3 * 5u);
  move_to(trail, 7.3, Later::skip);
  EXPECT_EQ(trail.lengths().back(), 7);
  EXPECT_EQ(trail.wake(2.5f).size(), 3 * 3u) << "5, 6 and 7";
  move_to(trail, 10, Later::skip);
  EXPECT_EQ(trail.lengths().size(), 11u);
}

TEST(Trail, WhatCameLaterIsForgottenWhenTheRobotGoesOnFromThere) {
  Trail trail = straight(10, 1);
  move_to(trail, 4.3, Later::keep);
  trail.pass({4.3f, 1, 0});
  trail.lengthen(0.5f, 5, Later::forget);
  ASSERT_EQ(trail.points().size(), 3 * 6u);
  EXPECT_EQ(trail.points()[3 * 5 + 1], 1);
  move_to(trail, 9, Later::keep);
  EXPECT_EQ(trail.points().size(), 3 * 7u);
}

TEST(Trail, AJumpIntoTheUnknownBeginsThePathThere) {
  Trail trail = straight(10, 1);
  move_to(trail, 30, Later::skip);
  EXPECT_EQ(trail.points().size(), 3u);
  EXPECT_EQ(trail.points()[0], 30);
  EXPECT_EQ(trail.start(), (Vec3{0, 0, 0}));
  move_to(trail, 31, Later::keep);
  EXPECT_EQ(trail.points().size(), 3 * 2u);
  move_to(trail, 2, Later::skip);
  EXPECT_EQ(trail.points().size(), 3u) << "before all that is known";
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
