// SPDX-License-Identifier: Apache-2.0
#include "robots/nn/cloud_spacing.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "mercury/random.h"

namespace mercury {
namespace {

// Normal points, nearly all of them within [-1, 1]^3; in pairs of mirror images if that is asked for.
std::vector<Vec3> normal_cloud(std::size_t points, bool in_pairs, std::uint64_t seed) {
  Random random(seed);
  const auto draw = [&](double size) { return std::clamp(static_cast<float>(size * random.normal()), -1.f, 1.f); };
  std::vector<Vec3> cloud;
  while (cloud.size() < points) {
    const float x = draw(0.3), y = draw(0.2), z = draw(0.1);
    cloud.push_back({x, y, z});
    if (in_pairs) cloud.push_back({x, -y, z});
  }
  return cloud;
}

double nearest_two(const std::vector<SpreadPoint>& points) {
  double nearest = 10;
  for (std::size_t i = 0; i < points.size(); ++i)
    for (std::size_t j = 0; j < i; ++j)
      nearest = std::min(nearest, static_cast<double>(length(points[i].place - points[j].place)));
  return nearest;
}

TEST(MeanSpacing, OfABallIsTheSideOfACubeWithAPointsShare) {
  std::vector<Vec3> ball;
  const double radius = 0.8;
  for (int x = -20; x <= 20; ++x)
    for (int y = -20; y <= 20; ++y)
      for (int z = -20; z <= 20; ++z) {
        const Vec3 place = {0.04f * static_cast<float>(x), 0.04f * static_cast<float>(y),
                            0.04f * static_cast<float>(z)};
        if (static_cast<double>(length(place)) < radius) ball.push_back(place);
      }
  const double volume = 4 * std::numbers::pi / 3 * radius * radius * radius;
  EXPECT_NEAR(mean_spacing(ball), std::cbrt(volume / static_cast<double>(ball.size())), 0.001);
  EXPECT_NEAR(mean_spacing(ball), 0.04, 0.0005);
}

TEST(MeanSpacing, DoesNotDependOnTheDirection) {
  std::vector<Vec3> cloud = normal_cloud(500, false, 1), turned;
  for (const Vec3& p : cloud) turned.push_back({0.6f * p.x - 0.8f * p.y, 0.8f * p.x + 0.6f * p.y, p.z});
  EXPECT_NEAR(mean_spacing(turned) / mean_spacing(cloud), 1, 1e-5);
}

TEST(MeanSpacing, OfAPlaneIsZero) {
  EXPECT_NEAR(mean_spacing(std::vector<Vec3>{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 0}}), 0, 1e-9);
}

TEST(Spread, KeepsPointsApart) {
  for (const bool in_pairs : {false, true})
    for (const double distance : {0.01, 0.05, 0.2, 0.9})
      for (std::uint64_t seed = 0; seed < 10; ++seed) {
        const std::vector<Vec3> cloud = normal_cloud(300, in_pairs, seed);
        const std::vector<SpreadPoint> points = spread(cloud, in_pairs, distance);
        ASSERT_GE(points.size(), 1u);
        // Differences of floats within [-1, 1] are rounded by 6e-8.
        ASSERT_GE(nearest_two(points), distance - 1e-6);
        ASSERT_TRUE(std::ranges::is_sorted(points, {}, &SpreadPoint::index));
        ASSERT_LT(points.back().index, cloud.size());
        for (const SpreadPoint& point : points)
          ASSERT_LE(std::max({std::abs(point.place.x), std::abs(point.place.y), std::abs(point.place.z)}), 1);
      }
}

TEST(Spread, LeavesPointsAloneThatAreFarApart) {
  std::vector<Vec3> lattice;
  for (int x = -2; x <= 2; ++x)
    for (int y = -2; y <= 2; ++y) lattice.push_back({0.4f * static_cast<float>(x), 0.4f * static_cast<float>(y), 0});
  const std::vector<SpreadPoint> points = spread(lattice, false, 0.19);
  ASSERT_EQ(points.size(), lattice.size());
  for (std::size_t i = 0; i < points.size(); ++i) EXPECT_EQ(points[i].place, lattice[i]);
}

TEST(Spread, MakesOnePointOfManyOnOnePlace) {
  const std::vector<Vec3> cloud(1000, Vec3{0.5f, 0.5f, 0});
  const std::vector<SpreadPoint> points = spread(cloud, false, 0.1);
  ASSERT_EQ(points.size(), 1u);
  EXPECT_EQ(points[0].place, cloud[0]);
}

TEST(Spread, KeepsTheOutermostPoints) {
  // The second of two near points is farther out.
  const std::vector<SpreadPoint> points = spread(std::vector<Vec3>{{0.9f, 0, 0}, {0.95f, 0, 0}, {0, 0, 0}}, false, 0.1);
  ASSERT_EQ(points.size(), 2u);
  EXPECT_EQ(points[0].index, 1u);
}

TEST(Spread, AMirroredCloudStaysMirrored) {
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    const std::vector<SpreadPoint> points = spread(normal_cloud(300, true, seed), true, 0.08);
    for (const SpreadPoint& point : points) {
      const Vec3 image = {point.place.x, -point.place.y, point.place.z};
      ASSERT_TRUE(std::ranges::any_of(points, [&](const SpreadPoint& other) {
        return length(other.place - image) < 1e-5f;
      })) << seed;
    }
  }
}

TEST(Spread, APairAtTheMirrorBecomesOnePointInIt) {
  const std::vector<SpreadPoint> points =
      spread(std::vector<Vec3>{{0.5f, 0.02f, 0}, {0.5f, -0.02f, 0}, {-0.5f, 0.3f, 0}, {-0.5f, -0.3f, 0}}, true, 0.1);
  ASSERT_EQ(points.size(), 3u);
  EXPECT_EQ(points[0].index, 0u);
  EXPECT_EQ(points[0].place, (Vec3{0.5f, 0, 0}));
  EXPECT_EQ(points[2].index, 3u);
}

}  // namespace
}  // namespace mercury
