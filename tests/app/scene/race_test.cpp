// SPDX-License-Identifier: Apache-2.0
// Lanes, marks and the order of passing.
#include "app/scene/race.h"

#include <gtest/gtest.h>

#include <cmath>

namespace mercury {
namespace {

TEST(MarkTimes, TheOrderIsThatOfTheirTimes) {
  MarkTimes passings(0.5f);
  for (int i = 0; i <= 100; ++i) {
    const double time = 0.1 * i;
    const auto t = static_cast<float>(time);
    passings.update(time, std::vector<float>{0.1f * t, 0.3f * t, 0.02f * t});
  }
  EXPECT_EQ(passings.farthest(), 6u);  // 3 m after 10 s, less rounding
  const auto first = passings.at(1);
  ASSERT_EQ(first.size(), 2u) << "the third has come 20 cm";
  EXPECT_EQ(first[0].robot, 1u);
  EXPECT_NEAR(first[0].time, 0.5 / 0.3, 1e-5);
  EXPECT_EQ(first[1].robot, 0u);
  EXPECT_NEAR(first[1].time, 5, 1e-5);
  EXPECT_EQ(order_text(passings, 1, std::vector<std::string>{"a", "b", "c"}).substr(0, 15), "order at 3 m\n1.");
}

TEST(MarkTimes, WhenTimeGoesBackLaterOnesAreForgotten) {
  MarkTimes passings(1);
  passings.update(0, std::vector<float>{0});
  passings.update(1, std::vector<float>{1.5f});
  passings.update(2, std::vector<float>{3.5f});
  passings.update(1.5, std::vector<float>{2.0f});
  ASSERT_EQ(passings.at(2).size(), 1u);
  EXPECT_NEAR(passings.at(2)[0].time, 1.25, 1e-6) << "between 1.5 m at 1 s and 3.5 m at 2 s";
  EXPECT_TRUE(passings.at(3).empty());
}

TEST(MarkTimes, WhatWasBeforeTheFirstPictureIsUnknown) {
  MarkTimes passings(1);
  passings.update(15, std::vector<float>{4.5f, 0.5f});
  EXPECT_TRUE(order_text(passings, 1, std::vector<std::string>{"a", "b"}).empty());
  passings.update(17, std::vector<float>{5.5f, 0.6f});
  EXPECT_EQ(order_text(passings, 1, std::vector<std::string>{"a", "b"}), "order at 5 m\n1. a, 16.0 s");
}

TEST(MarkTimes, ARobotThatHasExplodedArrivesNoMore) {
  MarkTimes passings(1);
  passings.update(0, std::vector<float>{0});
  passings.update(1, std::vector<float>{1.5f});
  passings.update(2, std::vector<float>{-1});
  EXPECT_EQ(passings.farthest(), 1u);
  EXPECT_TRUE(order_text(MarkTimes(1), 1, {}).empty());
}

TEST(Course, LinesAreRoundDistancesApartAndFew) {
  for (const float distance : {0.1f, 0.2f, 0.5f, 1.0f, 2.0f, 5.0f})
    for (const float length : {0.01f, 3.0f, 47.0f, 1234.0f}) {
      const auto step = static_cast<float>(marks_per_line(distance, length));
      EXPECT_LE(length / (step * distance), 10 + 1e-3f);
      const float mantissa = step * distance / std::pow(10.0f, std::floor(std::log10(step * distance) + 1e-4f));
      EXPECT_TRUE(std::abs(mantissa - 1) < 1e-3f || std::abs(mantissa - 2) < 1e-3f || std::abs(mantissa - 5) < 1e-3f)
          << step * distance;
    }
}

TEST(Course, MarksStandFromTheStartLineOnAndLanesReachTheirRobots) {
  MarkTimes passings(1);
  const std::vector<Lane> lanes{{{3, 0, 0}, 1, 2.5f, render::rgb(0xff0000)},
                                {{3, -2, 0}, 1, 0.5f, render::rgb(0xff00)}};
  Course course;
  course.draw(lanes, {1, 0, 0}, 0.25f, passings, 1, render::Theme::dark);
  ASSERT_EQ(course.numbers().size(), 4u);  // start, and marks up to the one before the leader
  for (std::size_t i = 0; i < 4; ++i) EXPECT_NEAR(course.numbers()[i].at.x, 3 + static_cast<float>(i), 1e-5);
  EXPECT_EQ(course.numbers()[3].text, "3 m");
  bool reached = false;
  for (const render::Path& line : course.lines()) {
    ASSERT_EQ(line.points.size(), 6u);
    EXPECT_EQ(line.body, render::Path::no_body);
    EXPECT_FLOAT_EQ(line.points[2], 0.25f);
    reached = reached || (line.points[3] == 5.5f && line.points[4] == 0);
  }
  EXPECT_TRUE(reached);
}

}  // namespace
}  // namespace mercury
