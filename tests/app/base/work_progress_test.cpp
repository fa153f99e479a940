// SPDX-License-Identifier: Apache-2.0
// Long functions of the libraries stop at the first Ctrl-C.
#include "app/base/work_progress.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <csignal>

#include "app/base/interrupt.h"
#include "mercury/generator.h"

namespace mercury {
namespace {

TEST(ShownWork, LetsWorkGoOnWithoutASignal) {
  const WorkWatch watch = shown_work();
  for (std::size_t i = 1; i <= 10; ++i) watch("making robots", i, 10);
  EXPECT_EQ(make_random_robots({.kind = "voxel", .count = 20}, nullptr, watch).size(), 20u);
}

TEST(ShownWorkDeathTest, EndsTheMakingOfRobotsAfterASignal) {
  GTEST_FLAG_SET(death_test_style, "threadsafe");
  constexpr int stopped = 7;
  EXPECT_EXIT(
      {
        catch_interrupts();
        raise(SIGINT);
        try {
          make_random_robots({.kind = "voxel", .count = 1000}, nullptr, shown_work());
        } catch (const Interrupted&) {
          _exit(stopped);
        }
        _exit(1);
      },
      testing::ExitedWithCode(stopped), "");
}

}  // namespace
}  // namespace mercury
