// SPDX-License-Identifier: Apache-2.0
#include "render/particles.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace mercury::render {
namespace {

const std::array movers{Mover{{0.1f, -0.2f, 0.3f}, 0.5f, {0.7f, 0.2f, -0.4f}},
                        Mover{{0.9f, 0.1f, 0.2f}, 0.3f, {-0.3f, 0.5f, 0.1f}}};

TEST(CarriedFlow, HasNoSources) {
  constexpr float step = 1e-2f;
  double worst = 0, largest = 0;
  for (float x = -1.5f; x < 2; x += 0.13f)
    for (float y = -1.5f; y < 1.5f; y += 0.17f)
      for (float z = -1; z < 1.5f; z += 0.19f) {
        const auto slope = [&](std::size_t axis) {
          const Vector3 d = step * Vector3::unit(int(axis));
          const Vector3 p(x, y, z), difference = carried_flow(movers, p + d) - carried_flow(movers, p - d);
          const std::array parts{difference.x, difference.y, difference.z};
          return std::array{double(parts[axis]) / (2.0 * step), double(difference.norm()) / (2.0 * step)};
        };
        const auto a = slope(0), b = slope(1), c = slope(2);
        worst = std::max(worst, std::abs(a[0] + b[0] + c[0]));
        largest = std::max({largest, a[1], b[1], c[1]});
      }
  EXPECT_GT(largest, 1) << "it varies";
  EXPECT_LT(worst, 0.01 * largest);  // differences are exact to second order
}

TEST(CarriedFlow, IsTheMoversOwnInItsMiddleFlowsBackBesideItAndEndsFarAway) {
  const Mover one = movers[0];
  const std::span<const Mover> alone(movers.data(), 1);
  EXPECT_LT((carried_flow(alone, one.center) - one.velocity).norm(), 1e-6f);
  const Vector3 across = one.velocity.cross(Vector3::unit(0)).normalized();
  EXPECT_LT(carried_flow(alone, one.center + 1.6f * one.radius * across).dot(one.velocity), 0);
  EXPECT_EQ(carried_flow(alone, one.center + 2.5f * one.radius * across).norm(), 0);
  // Through any plane across its way, as much flows back as forth.
  const Vector3 along = one.velocity.normalized(), second = along.cross(across);
  double through = 0, forth = 0;
  for (int i = -60; i <= 60; ++i)
    for (int j = -60; j <= 60; ++j) {
      const Vector3 at =
          one.center + 0.3f * one.radius * along + one.radius / 24 * (float(i) * across + float(j) * second);
      const double flow = carried_flow(alone, at).dot(along);
      through += flow;
      forth += std::max(0.0, flow);
    }
  EXPECT_LT(std::abs(through), 1e-3 * forth);
}

TEST(Particles, DependOnTheTimeAloneAndThoseFarFromMoversStay) {
  Scene scene;
  scene.time = 12.5;
  const auto still = particles_in(scene, {0, 0, 0}, 4, 500);
  scene.movers = movers;
  const auto pushed = particles_in(scene, {0, 0, 0}, 4, 500);
  int moved = 0;
  for (std::size_t i = 0; i < still.size(); ++i) {
    const bool near = std::ranges::any_of(
        movers, [&](const Mover& m) { return (still[i].center - m.center).norm() < 2.5f * m.radius; });
    const float way = (pushed[i].center - still[i].center).norm();
    moved += way > 0.01f;
    EXPECT_LT(way, 0.6f) << "less than a robot";
    if (!near) {
      EXPECT_EQ(way, 0);
    }
  }
  EXPECT_GT(moved, 3);
  const auto again = particles_in(scene, {0, 0, 0}, 4, 500);
  for (std::size_t i = 0; i < again.size(); ++i) EXPECT_EQ((again[i].center - pushed[i].center).norm(), 0);
}

TEST(Particles, BubblesRise) {
  Scene scene;
  const auto before = particles_in(scene, {0, 0, 0}, 4, 300);
  scene.time = 0.5;
  const auto after = particles_in(scene, {0, 0, 0}, 4, 300);
  int bubbles = 0, rising = 0;
  for (std::size_t i = 0; i < before.size(); ++i) {
    if (before[i].bubble == 0) continue;
    ++bubbles;
    rising += after[i].center.z > before[i].center.z;
  }
  EXPECT_GT(bubbles, 20);
  EXPECT_GT(rising, bubbles * 9 / 10);  // a few come in again from below
}

}  // namespace
}  // namespace mercury::render
