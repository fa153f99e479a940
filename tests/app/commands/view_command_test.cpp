// SPDX-License-Identifier: Apache-2.0
// mercury view without a display: errors and the sample robots.
#include <gmock/gmock.h>

#include <algorithm>

#include "app/window/toolkit/embedded.h"
#include "mercury/origin.h"
#include "tests/app/program.h"

namespace mercury::test {
namespace {

using testing::HasSubstr;
using testing::Not;

Outcome without_display(const Arguments& arguments) {
  return run_program("env", joined({"-u", "DISPLAY", "-u", "WAYLAND_DISPLAY", MERCURY_PROGRAM}, arguments));
}

TEST(ViewCommand, WithoutADisplayTheMessageNamesRender) {
  const Outcome outcome = without_display({"view"});
  EXPECT_EQ(outcome.status, 1);
  EXPECT_EQ(outcome.output, "");
  EXPECT_THAT(outcome.messages, HasSubstr("no display"));
  EXPECT_THAT(outcome.messages, HasSubstr("mercury render"));
  EXPECT_EQ(std::count(outcome.messages.begin(), outcome.messages.end(), '\n'), 1);
}

TEST(ViewCommand, InvalidInputIsReportedBeforeAWindowOpens) {
  const Outcome robot = without_display({"view", "nowhere.json"});
  EXPECT_EQ(robot.status, 2);
  EXPECT_THAT(robot.messages, HasSubstr("nowhere.json"));
  EXPECT_THAT(robot.messages, Not(HasSubstr("display")));
  EXPECT_THAT(without_display({"view", "--size", "1280"}), Ends(2, HasSubstr("--size")));
}

TEST(SampleRobots, AreChosenByTheirEnvironment) {
  std::size_t all = 0;
  for (const std::string environment : {"ocean", "water", "land"}) {
    const std::vector<Robot> robots = window::sample_robots(environment);
    EXPECT_FALSE(robots.empty());
    for (const Robot& robot : robots) EXPECT_EQ(environment_of(robot), environment) << robot.name;
    all += robots.size();
  }
  EXPECT_EQ(window::sample_robots("").size(), all);
}

}  // namespace
}  // namespace mercury::test
