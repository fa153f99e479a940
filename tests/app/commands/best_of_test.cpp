// SPDX-License-Identifier: Apache-2.0
// The search of `mercury new --best-of`.
#include "app/commands/best_of.h"

#include <gtest/gtest.h>

#include "mercury/error.h"
#include "mercury/random_voxel.h"
#include "mercury/simulation.h"

namespace mercury {
namespace {

Robot make(std::uint64_t seed, std::uint64_t index) {
  if (index == 1) throw InputError("cloud", "none");
  return random_voxel_robot({.smallest = {3, 2, 2}, .largest = {3, 2, 2}}, seed, index);
}

TEST(BestOf, DistanceIsMeasuredFromTheSettledPlace) {
  const Configuration configuration{.environment = Land{}, .device = {.kind = DeviceKind::cpu}};
  const auto winners =
      best_of({.candidates = 1, .configuration = configuration, .steps = 900, .settling = 500}, make, 3, 1);
  ASSERT_EQ(winners.size(), 1u);
  Simulation simulation(configuration, std::vector<Robot>{make(3, 0)});
  simulation.step(500);
  const Vec3 settled = simulation.telemetry(0).center_of_mass;
  simulation.step(400);
  Vec3 path = simulation.telemetry(0).center_of_mass - settled;
  path.z = 0;
  EXPECT_EQ(winners[0].distance, static_cast<double>(length(path)));
  EXPECT_GT(winners[0].distance, 0);
}

TEST(BestOf, LeavesOutFailedRobotsAndSortsTheOthers) {
  const auto winners = best_of({.candidates = 5, .configuration = {}, .steps = 300}, make, 3, 5);
  ASSERT_EQ(winners.size(), 4u);
  for (std::size_t i = 1; i < winners.size(); ++i) EXPECT_GE(winners[i - 1].distance, winners[i].distance);
}

}  // namespace
}  // namespace mercury
