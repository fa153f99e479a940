// SPDX-License-Identifier: Apache-2.0
// Callers see how the loading of a batch goes on, and can end it.
#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "tests/sim/backend.h"
#include "tests/sim/bodies.h"

namespace mercury {
namespace {

std::vector<std::shared_ptr<const Robot>> different_robots(int count) {
  std::vector<std::shared_ptr<const Robot>> robots;
  for (int i = 0; i < count; ++i)
    robots.push_back(std::make_shared<const Robot>(bodies::random_voxels({1 + i % 4, 2, 1 + i % 3}, 7)));
  return robots;
}

class LoadWatch : public BackendTest {
 protected:
  // With few robots per thread, none would be stepped in groups.
  Configuration configuration() const { return {.device = {.kind = GetParam(), .threads = 1}}; }
  const std::vector<std::shared_ptr<const Robot>> robots_ = different_robots(60);
};

TEST_P(LoadWatch, SeesAllPartsOfLoading) {
  std::map<std::string, std::size_t> most;
  Simulation watched(configuration(), robots_, [&](const char* what, std::size_t done, std::size_t total) {
    EXPECT_GE(done, 1u);
    EXPECT_LE(done, total);
    most[what] = std::max(most[what], done);
  });
  EXPECT_TRUE(most.contains("checking robots"));
  EXPECT_TRUE(most.contains("arranging robots"));
  Simulation alone(configuration(), robots_);
  watched.step(50);
  alone.step(50);
  EXPECT_EQ(watched.hashes(), alone.hashes());
  EXPECT_EQ(most.contains("grouping robots"), device().kind == DeviceKind::cpu);
  const auto seen = most;
  watched.add(*robots_[0]);
  watched.step(1);
  EXPECT_EQ(most, seen);  // only up to the first step
}

TEST_P(LoadWatch, AnExceptionEndsTheLoading) {
  struct Stop {};
  for (const std::string part : {"checking robots", "arranging robots"}) {
    const auto stop = [&](const char* what, std::size_t, std::size_t) {
      if (what == part) throw Stop();
    };
    EXPECT_THROW(Simulation(configuration(), robots_, stop), Stop) << part;
  }
}

INSTANTIATE_TEST_SUITE_P(Backends, LoadWatch, every_device, BackendTest::name);

TEST(LoadWatchOnTheCpu, AnExceptionEndsTheFirstStep) {
  struct Stop {};
  Simulation simulation({.device = {.kind = DeviceKind::cpu, .threads = 1}}, different_robots(60),
                        [](const char* what, std::size_t, std::size_t) {
                          if (std::string(what) == "grouping robots") throw Stop();
                        });
  EXPECT_THROW(simulation.step(1), Stop);
}

}  // namespace
}  // namespace mercury
