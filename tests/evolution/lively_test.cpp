// SPDX-License-Identifier: Apache-2.0
#include "mercury/lively.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <utility>

#include "mercury/distance.h"
#include "mercury/simulation.h"
#include "mercury/trials.h"

namespace mercury {
namespace {

// The distances of all that were tried, each in a simulation of its own.
TEST(Lively, AreTheRobotsThatGetFarthest) {
  const RandomRobots request{.kind = "voxel", .count = 2, .seed = 4, .first = 3};
  const Configuration configuration = lively_configuration(request);
  std::vector<std::pair<double, std::uint64_t>> ranking;
  for (std::uint64_t index = 3; index < 23; ++index) {
    const Robot robot = generator_named("voxel").make({}, "", 4, index);
    std::vector<Vec3> positions = robot.masses;
    add_jitter(robot, {.jitter = usual_jitter}, 4, 0, positions);
    Simulation simulation(configuration, std::vector<Robot>{robot});
    simulation.reset_to(positions);
    const Vec3 start = simulation.telemetry(0).center_of_mass;
    simulation.step(4000);
    ranking.emplace_back(-distance_between(start, simulation.telemetry(0).center_of_mass, configuration.environment),
                         index);
  }
  std::ranges::sort(ranking);
  EXPECT_THAT(liveliest(request, configuration), testing::ElementsAre(ranking[0].second, ranking[1].second));
  EXPECT_EQ(liveliest(request, configuration), liveliest(request, configuration));
}

TEST(Lively, AreTriedWhereTheyCanMove) {
  EXPECT_EQ(name_of(lively_configuration({.kind = "voxel"}, "land").environment), "land");
  EXPECT_EQ(name_of(lively_configuration({.kind = "voxel"}, "ocean-simple").environment), "ocean");
  EXPECT_EQ(name_of(lively_configuration({.kind = "voxel"}).environment), "ocean");
}

TEST(Lively, NoneAreChosenIfTheWatchSaysToStop) {
  const RandomRobots request{.kind = "voxel", .count = 20};
  EXPECT_TRUE(
      lively_requests(request, lively_configuration(request), [](std::size_t, std::size_t) { return false; }).empty());
}

}  // namespace
}  // namespace mercury
