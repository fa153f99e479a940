// SPDX-License-Identifier: Apache-2.0
#include "sim/cuda/arranged_robots.h"

#include <gtest/gtest.h>

#include <memory>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "sim/cuda/rest_lengths.h"
#include "tests/sim/bodies.h"

namespace mercury::cuda {
namespace {

std::shared_ptr<const Robot> random_robot(std::uint64_t seed) {
  return std::make_shared<const Robot>(bodies::random_voxels({.x = 3, .y = 2, .z = 3}, seed));
}

std::optional<ArrangedRobots::Entry> take(ArrangedRobots& robots, const Robot& robot) {
  const Robot* const one = &robot;
  return std::move(robots.take(std::span(&one, 1)).front());
}

TEST(ArrangedRobots, GiveWhatARobotHasOtherwise) {
  ArrangedRobots robots;
  const auto robot = random_robot(1);
  robots.prepare(robot);
  const std::optional<ArrangedRobots::Entry> found = take(robots, *robot);
  ASSERT_TRUE(found && found->arrangement);
  EXPECT_EQ(found->robot, robot);
  const Arrangement wanted = arrange(*robot);
  EXPECT_EQ(found->arrangement->order->slots, wanted.order->slots);
  EXPECT_EQ(found->arrangement->schedule.row_start, wanted.schedule.row_start);
  EXPECT_EQ(found->arrangement->faces.size(), wanted.faces.size());
  EXPECT_EQ(found->findings.topology, topology_key(*robot));
  EXPECT_EQ(found->findings.record_words, record_words_for(*robot));
  EXPECT_EQ(found->findings.measures.squared_stretch_limit(), measure(*robot).squared_stretch_limit());
}

TEST(ArrangedRobots, AreTakenOnce) {
  ArrangedRobots robots;
  const auto robot = random_robot(1), other = random_robot(2);
  EXPECT_FALSE(take(robots, *robot));
  robots.prepare(robot);
  EXPECT_FALSE(take(robots, *other));
  EXPECT_TRUE(take(robots, *robot));
  EXPECT_FALSE(take(robots, *robot));
}

TEST(ArrangedRobots, HaveOneArrangementPerTopology) {
  ArrangedRobots robots;
  const auto robot = random_robot(1);
  Robot softer = *robot;
  for (Material& material : softer.materials) material.stiffness /= 2;
  const auto same_topology = std::make_shared<const Robot>(softer);
  robots.prepare(robot);
  robots.prepare(same_topology);
  const Robot* const both[] = {same_topology.get(), robot.get()};
  const std::vector<std::optional<ArrangedRobots::Entry>> found = robots.take(both);
  ASSERT_TRUE(found.size() == 2 && found[0] && found[1]);
  EXPECT_FALSE(found[0]->arrangement);
  EXPECT_TRUE(found[1]->arrangement);
  EXPECT_EQ(found[0]->findings.topology, found[1]->findings.topology);
}

TEST(ArrangedRobots, ArrangeATopologyAgainOnceItWasTaken) {
  ArrangedRobots robots;
  for (int portion = 0; portion < 2; ++portion) {
    const auto robot = random_robot(1);
    robots.prepare(robot);
    const std::optional<ArrangedRobots::Entry> found = take(robots, *robot);
    ASSERT_TRUE(found);
    EXPECT_TRUE(found->arrangement) << portion;
  }
}

TEST(ArrangedRobots, LiveUntilTheyAreTaken) {
  ArrangedRobots robots;
  auto robot = random_robot(1);
  const std::weak_ptr<const Robot> watched = robot;
  robots.prepare(robot);
  robot.reset();
  ASSERT_FALSE(watched.expired());
  take(robots, *watched.lock());
  EXPECT_TRUE(watched.expired());
}

TEST(ArrangedRobots, PassOverOneThatBreaksARule) {
  ArrangedRobots robots;
  Robot broken = *random_robot(1);
  broken.springs.front().a = 60000;
  const auto robot = std::make_shared<const Robot>(broken);
  robots.prepare(robot);
  EXPECT_FALSE(take(robots, *robot));
}

}  // namespace
}  // namespace mercury::cuda
