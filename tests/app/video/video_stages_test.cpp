// SPDX-License-Identifier: Apache-2.0
#include "app/video/video_stages.h"

#include <gtest/gtest.h>

#include <cmath>

namespace mercury::test {
namespace {

VideoTiming video(double rate, double speed) { return {.interval = speed / rate}; }

TEST(StepOfFrame, TenSecondsOfVideoAreTenSecondsOfSimulation) {
  EXPECT_EQ(step_of_frame(0, video(30, 1), 1e-3), 0);
  EXPECT_EQ(step_of_frame(300, video(30, 1), 1e-3), 10000);
  EXPECT_EQ(step_of_frame(300, video(30, 4), 1e-3), 40000);
  EXPECT_EQ(step_of_frame(600, video(60, 1), 7e-4), std::llround(10 / 7e-4));
  EXPECT_EQ(step_of_frame(0, {.start = 3}, 1e-3), 3000);
}

TEST(StepOfFrame, NoFrameIsOffByMoreThanHalfAStep) {
  for (const double rate : {24.0, 25.0, 30.0, 30000.0 / 1001, 60.0})
    for (const double dt : {1e-3, 7e-4, 1.0 / 3})
      for (std::int64_t frame = 0; frame < 100000; frame += 997) {
        const double time = static_cast<double>(step_of_frame(frame, video(rate, 1), dt)) * dt;
        EXPECT_NEAR(time, static_cast<double>(frame) / rate, 0.5 * dt * (1 + 1e-9));
      }
}

}  // namespace
}  // namespace mercury::test
