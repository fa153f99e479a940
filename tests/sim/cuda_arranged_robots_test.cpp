// SPDX-License-Identifier: Apache-2.0
#include "sim/cuda/arranged_robots.h"

#include <gtest/gtest.h>

#include <memory>

#include "tests/sim/bodies.h"

namespace mercury::cuda {
namespace {

std::shared_ptr<const Robot> random_robot(std::uint64_t seed) {
  return std::make_shared<const Robot>(bodies::random_voxels({.x = 3, .y = 2, .z = 3}, seed));
}

TEST(ArrangedRobots, GiveTheArrangementThatARobotHasOtherwise) {
  ArrangedRobots robots;
  const auto robot = random_robot(1);
  robots.prepare(robot);
  const std::unique_ptr<const Arrangement> found = robots.take(*robot);
  ASSERT_TRUE(found);
  const Arrangement wanted = arrange(*robot);
  EXPECT_EQ(found->order->slots, wanted.order->slots);
  EXPECT_EQ(found->schedule.row_start, wanted.schedule.row_start);
  EXPECT_EQ(found->faces.size(), wanted.faces.size());
}

TEST(ArrangedRobots, AreTakenOnce) {
  ArrangedRobots robots;
  const auto robot = random_robot(1), other = random_robot(2);
  EXPECT_FALSE(robots.take(*robot));
  robots.prepare(robot);
  EXPECT_FALSE(robots.take(*other));
  EXPECT_TRUE(robots.take(*robot));
  EXPECT_FALSE(robots.take(*robot));
}

TEST(ArrangedRobots, AreOnePerTopology) {
  ArrangedRobots robots;
  const auto robot = random_robot(1);
  Robot softer = *robot;
  for (Material& material : softer.materials) material.stiffness /= 2;
  const auto same_topology = std::make_shared<const Robot>(softer);
  robots.prepare(robot);
  robots.prepare(same_topology);
  EXPECT_FALSE(robots.take(*same_topology));
  EXPECT_TRUE(robots.take(*robot));
}

TEST(ArrangedRobots, LiveUntilTheyAreTaken) {
  ArrangedRobots robots;
  auto robot = random_robot(1);
  const std::weak_ptr<const Robot> watched = robot;
  robots.prepare(robot);
  robot.reset();
  ASSERT_FALSE(watched.expired());
  robots.take(*watched.lock());
  EXPECT_TRUE(watched.expired());
}

TEST(ArrangedRobots, PassOverOneThatBreaksARule) {
  ArrangedRobots robots;
  Robot broken = *random_robot(1);
  broken.springs.front().a = 60000;
  const auto robot = std::make_shared<const Robot>(broken);
  robots.prepare(robot);
  EXPECT_FALSE(robots.take(*robot));
}

}  // namespace
}  // namespace mercury::cuda
