// SPDX-License-Identifier: Apache-2.0
// Long functions of the libraries stop at the first Ctrl-C, and what does not stop is ended.
#include "app/base/interrupt.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <csignal>

#include "app/base/progress.h"
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

// Work that asks nobody whether it shall stop: it waits for the next signal, for ever. The alarm is blocked until then,
// so that it cannot come before.
void wait_for_a_signal() {
  sigset_t none;
  sigemptyset(&none);
  sigsuspend(&none);
}
void send_to_itself(int number) {
  sigset_t alarm;
  sigemptyset(&alarm);
  sigaddset(&alarm, SIGALRM);
  sigprocmask(SIG_BLOCK, &alarm, nullptr);
  raise(number);
}

TEST(InterruptDeathTest, EndsWorkThatDoesNotStopByItself) {
  GTEST_FLAG_SET(death_test_style, "threadsafe");
  EXPECT_EXIT(
      {
        catch_interrupts();
        send_to_itself(SIGTERM);
        while (true) wait_for_a_signal();
      },
      testing::ExitedWithCode(128 + SIGTERM), "mercury: stopped");
}

TEST(InterruptDeathTest, WaitsForUnsavedResultsUntilAnotherSignal) {
  GTEST_FLAG_SET(death_test_style, "threadsafe");
  EXPECT_EXIT(
      {
        catch_interrupts();
        UnsavedResults results;
        results.begin();
        send_to_itself(SIGINT);
        wait_for_a_signal();
        raise(SIGINT);
        _exit(1);
      },
      testing::ExitedWithCode(128 + SIGINT), "mercury: stopping, to keep the results so far");
}

// Results that are saved no longer hold the end back.
TEST(InterruptDeathTest, EndsWorkAfterItsResultsAreSaved) {
  GTEST_FLAG_SET(death_test_style, "threadsafe");
  EXPECT_EXIT(
      {
        catch_interrupts();
        {
          UnsavedResults results;
          results.begin();
        }
        send_to_itself(SIGINT);
        wait_for_a_signal();
        _exit(1);
      },
      testing::ExitedWithCode(128 + SIGINT), "mercury: stopped");
}

}  // namespace
}  // namespace mercury
