// SPDX-License-Identifier: Apache-2.0
#include "mercury/nn_robot.h"

#include <gtest/gtest.h>

#include <limits>
#include <set>
#include <string>

#include "tests/refusal.h"
#include "tests/robots/nn_bodies.h"

namespace mercury {
namespace {

std::string reason_not_to_grow(const NnGenome& genome) {
  return refusal([&] { grow(genome); });
}

TEST(NnCloud, RefusesCloudsThatSpanNoBodyWithTheReason) {
  EXPECT_EQ(reason_not_to_grow(simple_genome(nothing, nothing)), "cloud: the network puts all its points on one place");
  EXPECT_EQ(reason_not_to_grow(simple_genome({{1, 0, 0}, {0, 1, 0}, {0, 0, 0}}, {{-1, 0, 0}, {0, -1, 0}, {0, 0, 0}})),
            "cloud: its points lie in one plane, they span no body");
  EXPECT_EQ(reason_not_to_grow(simple_genome({{1, 0, 0}, {1, 0, 0}, {1, 0, 0}}, nothing)),
            "cloud: its points lie in one plane, they span no body");
  NnGenome overflowing = simple_genome(identity, minus_identity);
  overflowing.network.layers[0].weights.assign(18, 3e38f);
  EXPECT_EQ(reason_not_to_grow(overflowing), "cloud: the network gives places that are not finite");
  NnGenome far_away = simple_genome(identity, minus_identity);
  far_away.network.layers[1].biases[0] = 1e7f;
  EXPECT_EQ(reason_not_to_grow(far_away), "cloud: the network puts all its points on one place");
  for (const float bad : {std::numeric_limits<float>::quiet_NaN(), std::numeric_limits<float>::infinity()}) {
    NnGenome genome = simple_genome(identity, minus_identity);
    genome.network.layers[0].weights[4] = bad;
    EXPECT_EQ(reason_not_to_grow(genome), "network: a weight is not a finite number");
  }
  NnGenome genome = simple_genome(identity, minus_identity);
  genome.alpha = 1e-4f;
  EXPECT_EQ(reason_not_to_grow(genome), "alpha: no tetrahedron of the cloud is as small as the given radius");
  genome.alpha = -1;
  EXPECT_EQ(reason_not_to_grow(genome), "alpha: give a radius > 0 m, or 0 for the smallest that holds all points");
  genome.alpha = 0;
  genome.points = 63;
  EXPECT_EQ(reason_not_to_grow(genome), "points: 63 is not accepted; give 64 to 65535");
}

TEST(NnCloud, PointsOnOnePlaceAreOneMass) {
  // An eighth of all points goes to the corner, an eighth of the rest onto each of three edges, ...
  const Robot robot = grow(simple_genome(identity, nothing));
  check_body(robot);
  EXPECT_GT(robot.masses.size(), 150u);
  EXPECT_LT(robot.masses.size(), 195u);
}

TEST(NnCloud, PointsTooCloseForSpringsLeaveAWholeBody) {
  // Some points are thrown far out along x, the others lie ever closer together: first springs are left out, then
  // masses that lost them all, and the tetrahedra that need those.
  std::set<std::size_t> masses;
  for (float spread = 1e-2f; spread > 1e-7f; spread *= 0.7f) {
    NnGenome genome = simple_genome({{spread, 0, 0}, {0, spread, 0}, {0, 0, spread}},
                                    {{-spread, 0, 0}, {0, -spread, 0}, {0, 0, -spread}});
    genome.network.layers[0].biases[0] = -1.5f;
    genome.network.layers[1].weights[0] = 1;
    const Robot robot = grow(genome);
    check_body(robot);
    masses.insert(robot.masses.size());
  }
  EXPECT_EQ(*masses.rbegin(), 200u);
  EXPECT_LT(*masses.begin(), 150u);
  EXPECT_GT(masses.size(), 3u);
}

}  // namespace
}  // namespace mercury
