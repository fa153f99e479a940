// SPDX-License-Identifier: Apache-2.0
#include "app/base/progress.h"

#include <gtest/gtest.h>

namespace mercury::test {
namespace {

TEST(Progress, LineShowsRateAndTimeLeft) {
  // 150 frames in 3 s are 50 per second, so the other 150 take 3 s more.
  EXPECT_EQ(progress_line("rendering", "frames", 150, 300, 3),
            "rendering: 150/300 frames (50 %)  50 frames/s  0:03 left");
  EXPECT_EQ(progress_line("rendering", "frames", 0, 300, 1), "rendering: 0/300 frames (0 %)");
}

TEST(Progress, BarShowsTheFractionAndFitsTheTerminal) {
  EXPECT_EQ(progress_bar("rendering", "frames", 150, 300, 3, 200),
            "rendering [############............]  50 %  150/300 frames  50 frames/s  0:03 left");
  EXPECT_EQ(progress_bar("rendering", "frames", 300, 300, 6, 40).size(), 39u);
}

TEST(Progress, WhatIsDoneInPartCountsForTheBarAlone) {
  // Half of the work in 3 s leaves 3 s for the other half; the second of three robots is not done yet.
  EXPECT_EQ(progress_bar("simulating", "robots", {1, 1.5}, 3, 3, 200),
            "simulating [############............]  50 %  1/3 robots  0.50 robots/s  0:03 left");
  // Robots that are stepped side by side: none is done before all are.
  EXPECT_EQ(progress_line("simulating", "robots", {0, 5}, 10, 3),
            "simulating: 0/10 robots (50 %)  1.67 robots/s  0:03 left");
}

TEST(WithMagnitude, HasThreeDigits) {
  EXPECT_EQ(with_magnitude(0), "0");
  EXPECT_EQ(with_magnitude(7), "7");
  EXPECT_EQ(with_magnitude(7.256), "7.26");
  EXPECT_EQ(with_magnitude(72.56), "72.6");
  EXPECT_EQ(with_magnitude(999.4), "999");
  EXPECT_EQ(with_magnitude(999.6), "1.00 k");
  EXPECT_EQ(with_magnitude(12345), "12.3 k");
  EXPECT_EQ(with_magnitude(3.7e11), "370 G");
}

TEST(ClockText, ShowsMinutesAndHours) {
  EXPECT_EQ(clock_text(4.4), "0:04");
  EXPECT_EQ(clock_text(59.6), "1:00");
  EXPECT_EQ(clock_text(3723), "1:02:03");
}

TEST(DurationText, HasTheTwoLargestUnitsThatAreNotZero) {
  EXPECT_EQ(duration_text(0), "0.0 s");
  EXPECT_EQ(duration_text(4.24), "4.2 s");
  EXPECT_EQ(duration_text(53.3), "53 s");
  EXPECT_EQ(duration_text(59.7), "1 min");
  EXPECT_EQ(duration_text(725), "12 min 5 s");
  EXPECT_EQ(duration_text(3600), "1 h");
  EXPECT_EQ(duration_text(3 * 3600 + 7 * 60 + 29), "3 h 7 min");
}

}  // namespace
}  // namespace mercury::test
