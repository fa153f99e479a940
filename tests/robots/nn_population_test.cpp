// SPDX-License-Identifier: Apache-2.0
#include "mercury/nn_robot.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <set>
#include <string>
#include <vector>

#include "mercury/error.h"
#include "mercury/simulation.h"
#include "tests/refusal.h"
#include "tests/robots/nn_bodies.h"

namespace mercury {
namespace {

TEST(NnPopulation, BodiesOf500SeedsAreClosedSolidAndWhole) {
  int pinched = 0;
  for (const Robot& robot : random_nn_robots({.points = 96}, 1, 488)) pinched += check_body(robot);
  for (const Robot& robot : random_nn_robots({}, 2, 12)) pinched += check_body(robot);
  for (const Robot& robot : random_nn_robots({.spacing = 0}, 2, 12)) {
    pinched += check_body(robot);
    EXPECT_EQ(robot.masses.size(), 512u);
  }
  RecordProperty("edges_with_more_than_two_faces", pinched);
}

TEST(NnPopulation, HoldsWithAChosenAlphaToo) {
  std::vector<FailedRobot> failed;
  const auto robots = random_nn_robots({.points = 200, .alpha = 0.12f}, 3, 30, 0, &failed);
  EXPECT_GT(robots.size(), 20u);
  EXPECT_EQ(robots.size() + failed.size(), 30u);
  std::size_t smaller = 0;
  for (const Robot& robot : robots) {
    check_body(robot);
    smaller += robot.masses.size() < 200;
  }
  EXPECT_GT(smaller, 5u);  // stray points are left out
}

TEST(NnPopulation, OneOfAPopulationDoesNotDependOnTheOthers) {
  const NnOptions options{.points = 80};
  const auto many = random_nn_robots(options, 5, 9), few = random_nn_robots(options, 5, 4);
  for (std::size_t i = 0; i < few.size(); ++i) EXPECT_EQ(few[i], many[i]);
  EXPECT_EQ(few[3], grow(random_nn_genome(options, 5, 3), "nn-5-3"));
  EXPECT_EQ(random_nn_robots(options, 5, 2, 7)[1], many[8]);
  EXPECT_NE(many[0].masses, random_nn_robots(options, 6, 1)[0].masses);
}

TEST(NnPopulation, AFailureIsReportedAndTheOthersAreGrown) {
  std::vector<FailedRobot> failed;
  EXPECT_TRUE(random_nn_robots({.points = 64, .alpha = 1e-6f}, 1, 5, 10, &failed).empty());
  ASSERT_EQ(failed.size(), 5u);
  EXPECT_EQ(failed[4].index, 14u);
  EXPECT_EQ(failed[4].reason, "alpha: no tetrahedron of the cloud is as small as the given radius");
  EXPECT_THROW(random_nn_robots({.points = 64, .alpha = 1e-6f}, 1, 5), InputError);
}

TEST(NnPopulation, OptionsOutOfRangeAreNamed) {
  const auto message = [](const NnOptions& options) -> std::string {
    return refusal([&] { random_nn_robots(options, 1, 1); });
  };
  EXPECT_EQ(message({.hidden = {64, 3}}), "hidden: 3 is not accepted; give 6 to 4096");
  EXPECT_EQ(message({.hidden = std::vector<int>(16, 8)}), "hidden: 16 numbers are not accepted; give at most 15");
  EXPECT_EQ(message({.points = 63}), "points: 63 is not accepted; give 64 to 65535");
  EXPECT_EQ(message({.points = 65536}), "points: 65536 is not accepted; give 64 to 65535");
  EXPECT_EQ(message({.alpha = -0.5f}), "alpha: -0.5 is not accepted; give a finite number >= 0 m");
  EXPECT_EQ(message({.spacing = 1.5f}), "spacing: 1.5 is not accepted; give 0 to 1");
  EXPECT_EQ(message({.mirrored = 2}), "mirrored: 2 is not accepted; give 0 to 1");
}

TEST(NnPopulation, APopulationDiffersInShapeAndMaterials) {
  std::vector<double> flatness, slenderness;  // shortest and middle extent by the longest
  double fewest = 23, sum = 0;
  for (const Robot& robot : random_nn_robots({}, 1, 64)) {
    std::array<float, 3> extent{};
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const auto coordinate = [&](const Vec3& x) { return axis == 0 ? x.x : axis == 1 ? x.y : x.z; };
      float low = 1, high = -1;
      for (const Vec3& x : robot.masses) low = std::min(low, coordinate(x)), high = std::max(high, coordinate(x));
      extent[axis] = high - low;
    }
    std::sort(extent.begin(), extent.end());
    flatness.push_back(extent[0] / extent[2]);
    slenderness.push_back(extent[1] / extent[2]);
    std::set<MaterialId> base;
    for (const Spring& s : robot.springs) {
      const auto [i, j] = base_materials_of(s.material);
      base.insert(i);
      base.insert(j);
    }
    fewest = std::min(fewest, static_cast<double>(base.size()));
    sum += static_cast<double>(base.size()) / 64;
  }
  const auto quantile = [](std::vector<double> values, std::size_t of_64) {
    std::sort(values.begin(), values.end());
    return values[of_64];
  };
  // In a population of one shape all values are equal.
  EXPECT_LT(quantile(flatness, 8), 0.7 * quantile(flatness, 56));
  EXPECT_LT(quantile(slenderness, 8), 0.7 * quantile(slenderness, 56));
  EXPECT_GE(fewest, 2);
  EXPECT_GE(sum, 4);
}

// Median over robots of the largest strain of any spring, sampled every 0.1 s.
double median_strain(const NnOptions& options) {
  const std::vector<Robot> robots = random_nn_robots(options, 1, 20);
  Simulation simulation({}, robots);
  std::vector<float> largest(robots.size(), 0);
  for (int sample = 0; sample < 60; ++sample) {
    simulation.step(100);
    const auto telemetry = simulation.telemetry();
    for (std::size_t i = 0; i < robots.size(); ++i) largest[i] = std::max(largest[i], telemetry[i].largest_strain);
  }
  std::ranges::sort(largest);
  return largest[robots.size() / 2];
}

TEST(NnPopulation, SpacingKeepsSpringsFromBeingTorn) {
  EXPECT_GT(median_strain({.points = 200, .spacing = 0}), 2);
  EXPECT_LT(median_strain({.points = 200}), 1);
}

}  // namespace
}  // namespace mercury
