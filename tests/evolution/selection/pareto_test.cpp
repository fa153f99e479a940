// SPDX-License-Identifier: Apache-2.0
// Fronts and crowding against what their definitions say, computed the long way.
#include "evolution/selection/ranking.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "mercury/random.h"

namespace mercury {
namespace {

using testing::ElementsAre;

constexpr double infinite = std::numeric_limits<double>::infinity();

// Points on a coarse lattice, so that there are equal values and equal points.
Points random_points(std::size_t count, std::size_t dimensions, std::uint64_t seed, std::uint64_t levels) {
  Random random(seed);
  Points points{.dimensions = dimensions, .values = {}};
  for (std::size_t i = 0; i < count * dimensions; ++i)
    points.values.push_back(random.chance(0.02) ? -infinite : static_cast<double>(random.below(levels)));
  return points;
}

bool dominates_by_definition(const Points& points, std::size_t a, std::size_t b) {
  int worse = 0, better = 0;
  for (std::size_t d = 0; d < points.dimensions; ++d) {
    worse += points.values[a * points.dimensions + d] < points.values[b * points.dimensions + d];
    better += points.values[a * points.dimensions + d] > points.values[b * points.dimensions + d];
  }
  return worse == 0 && better > 0;
}

// Takes what nothing left dominates, again and again.
std::vector<std::vector<std::size_t>> fronts_by_definition(const Points& points) {
  std::vector<std::vector<std::size_t>> fronts;
  std::vector<std::size_t> left(points.size());
  for (std::size_t i = 0; i < left.size(); ++i) left[i] = i;
  while (!left.empty()) {
    std::vector<std::size_t> front, rest;
    for (const std::size_t i : left) {
      const bool is_dominated =
          std::ranges::any_of(left, [&](std::size_t j) { return dominates_by_definition(points, j, i); });
      (is_dominated ? rest : front).push_back(i);
    }
    fronts.push_back(front);
    left = rest;
  }
  return fronts;
}

TEST(Pareto, FrontsAreThoseOfTheDefinition) {
  for (std::uint64_t seed = 1; seed <= 60; ++seed) {
    const std::size_t dimensions = 1 + seed % 4;
    const Points points = random_points(seed * 3, dimensions, seed, seed % 2 ? 5 : 1000);
    EXPECT_EQ(fronts_of(points), fronts_by_definition(points)) << seed;
  }
}

TEST(Pareto, NoPointsHaveNoFronts) { EXPECT_TRUE(fronts_of({.dimensions = 2, .values = {}}).empty()); }

TEST(Pareto, EqualPointsShareAFront) {
  EXPECT_THAT(fronts_of({.dimensions = 2, .values = {1, 1, 2, 2, 1, 1, 2, 2, 3, 1}}),
              ElementsAre(ElementsAre(1, 3, 4), ElementsAre(0, 2)));
}

// Points on a line from (0, 3) to (3, 0): inner ones have (difference of neighbors / range) summed over both values.
TEST(Pareto, CrowdingOfAnEvenLine) {
  const Points points{.dimensions = 2, .values = {1, 2, 3, 0, 0, 3, 2, 1}};
  const std::vector<std::size_t> front{0, 1, 2, 3};
  EXPECT_THAT(crowding_distances(points, front),
              ElementsAre(testing::DoubleEq(4.0 / 3), infinite, infinite, testing::DoubleEq(4.0 / 3)));
}

TEST(Pareto, CrowdingIsThatOfTheDefinition) {
  for (std::uint64_t seed = 1; seed <= 30; ++seed) {
    Random random(seed);
    Points points{.dimensions = 1 + seed % 3, .values = {}};
    const std::size_t count = 3 + random.below(40);
    for (std::size_t i = 0; i < count * points.dimensions; ++i) points.values.push_back(random.uniform());
    std::vector<std::size_t> front;
    for (std::size_t i = 0; i < count; ++i)
      if (random.chance(0.8)) front.push_back(i);
    if (front.empty()) front.push_back(0);
    const std::vector<double> crowding = crowding_distances(points, front);
    for (std::size_t k = 0; k < front.size(); ++k) {
      double expected = 0;
      for (std::size_t d = 0; d < points.dimensions; ++d) {
        // All values differ, so the neighbors are the nearest values on either side.
        const double x = points[front[k]][d];
        double below = -infinite, above = infinite, lowest = infinite, highest = -infinite;
        for (const std::size_t i : front) {
          const double y = points[i][d];
          if (y < x) below = std::max(below, y);
          if (y > x) above = std::min(above, y);
          lowest = std::min(lowest, y);
          highest = std::max(highest, y);
        }
        expected += (above - below) / (highest - lowest);
      }
      if (std::isfinite(expected))
        EXPECT_DOUBLE_EQ(crowding[k], expected);
      else
        EXPECT_EQ(crowding[k], infinite);
    }
  }
}

TEST(Pareto, CrowdingOfWorstScoresIsNoNaN) {
  const Points points{.dimensions = 2,
                      .values = {-infinite, 1, -infinite, 2, 0, 0, 1, -infinite, -infinite, -infinite}};
  const std::vector<std::size_t> front{0, 1, 2, 3, 4};
  for (const double distance : crowding_distances(points, front)) EXPECT_GE(distance, 0);
  const Points same{.dimensions = 1, .values = std::vector<double>(5, -infinite)};
  EXPECT_THAT(crowding_distances(same, front), ElementsAre(infinite, 0, 0, 0, infinite));
}

}  // namespace
}  // namespace mercury
