// On one backend a robot's trajectory is bit for bit the same from run to run, alone or in any batch, in any order, with
// any number of threads, and however the steps are split into calls.
#include <gtest/gtest.h>

#include <algorithm>

#include "backend.h"
#include "bodies.h"

namespace mercury {
namespace {

class Reproducibility : public EveryPair {
 protected:
  static constexpr std::int64_t steps = 400;

  // Robots of many sizes, dropped or shaken.
  static std::vector<Robot> crowd() {
    std::vector<Robot> robots;
    std::uint64_t seed = 1;
    for (const auto& [x, y, z] : {std::array{1, 1, 1}, {5, 5, 5}, {2, 3, 1}, {4, 4, 4}, {9, 8, 7}, {3, 3, 3}, {1, 2, 6}}) {
      robots.push_back(bodies::random_voxels({.x = x, .y = y, .z = z}, seed));
      bodies::rotate(robots.back(), bodies::random_rotation(seed++));
    }
    robots.push_back(bodies::pair({50, 0.5f, 3, 0.2f}));
    robots.push_back(bodies::point({0, 0, 1}));
    return robots;
  }

  // One hash a robot after `steps`, in the order of `robots`.
  static std::vector<std::uint64_t> run(const Configuration& configuration, std::span<const Robot> robots,
                                        std::int64_t steps_a_call = steps) {
    Simulation simulation(configuration, robots);
    for (std::size_t i = 0; i < robots.size(); ++i) {
      State start = bodies::shaken(robots[i], 0.01f, 0.3f, 7);
      for (Vec3& x : start.positions) x.z += 0.05f;
      simulation.set_state(i, start.positions, start.velocities);
    }
    for (std::int64_t done = 0; done < steps; done += steps_a_call)
      simulation.step(std::min(steps_a_call, steps - done));
    std::vector<std::uint64_t> hashes;
    for (std::size_t i = 0; i < robots.size(); ++i) {
      hashes.push_back(simulation.hash(i));
      EXPECT_FALSE(simulation.telemetry(i).exploded) << i;
    }
    return hashes;
  }
};
INSTANTIATE_TEST_SUITE_P(All, Reproducibility, every_pair, EveryPair::name);

TEST_P(Reproducibility, HashesAreTheSameTwiceAndDifferentForDifferentRobots) {
  const auto robots = crowd();
  auto hashes = run(configuration(), robots);
  EXPECT_EQ(run(configuration(), robots), hashes);
  std::ranges::sort(hashes);
  EXPECT_TRUE(std::ranges::adjacent_find(hashes) == hashes.end());
}

TEST_P(Reproducibility, OneThreadGivesTheHashesOfMany) {
  const auto robots = crowd();
  Configuration one = configuration(), many = configuration();
  one.device.threads = 1;
  many.device.threads = 5;
  EXPECT_EQ(run(one, robots), run(configuration(), robots));
  EXPECT_EQ(run(many, robots), run(configuration(), robots));
}

TEST_P(Reproducibility, ARobotAloneMovesAsInTheBatch) {
  const auto robots = crowd();
  const auto hashes = run(configuration(), robots);
  for (std::size_t i = 0; i < robots.size(); ++i)
    EXPECT_EQ(run(configuration(), std::span(robots).subspan(i, 1)).front(), hashes[i]) << i;
}

TEST_P(Reproducibility, TheOrderOfTheBatchDoesNotMatter) {
  auto robots = crowd();
  auto hashes = run(configuration(), robots);
  std::ranges::reverse(robots);
  std::ranges::reverse(hashes);
  EXPECT_EQ(run(configuration(), robots), hashes);
  std::ranges::rotate(robots, robots.begin() + 3);
  std::ranges::rotate(hashes, hashes.begin() + 3);
  EXPECT_EQ(run(configuration(), robots), hashes);
}

TEST_P(Reproducibility, ManyCallsGiveTheHashesOfOne) {
  const auto robots = crowd();
  const auto hashes = run(configuration(), robots);
  EXPECT_EQ(run(configuration(), robots, 1), hashes);
  EXPECT_EQ(run(configuration(), robots, 7), hashes);
  EXPECT_EQ(run(configuration(), robots, 256), hashes);
}

TEST_P(Reproducibility, RobotsAddedToARunningBatchDoNotDisturbIt) {
  const auto robots = crowd();
  Simulation alone(configuration(), std::span(robots).first(4));
  Simulation joined(configuration(), std::span(robots).first(4));
  alone.step(100);
  joined.step(100);
  EXPECT_EQ(joined.add(std::span(robots).subspan(4)), 4u);
  alone.step(100);
  joined.step(100);
  for (std::size_t i = 0; i < 4; ++i) EXPECT_EQ(joined.hash(i), alone.hash(i)) << i;
}

TEST_P(Reproducibility, ResetStartsTheSameTrajectoryAgain) {
  const auto robots = crowd();
  Simulation simulation(configuration(), robots);
  simulation.step(123);
  std::vector<std::uint64_t> first;
  for (std::size_t i = 0; i < robots.size(); ++i) first.push_back(simulation.hash(i));
  simulation.step(77);
  simulation.reset();
  EXPECT_EQ(simulation.time(), 0);
  EXPECT_EQ(simulation.steps(), 0);
  simulation.step(123);
  for (std::size_t i = 0; i < robots.size(); ++i) EXPECT_EQ(simulation.hash(i), first[i]) << i;
}

TEST_P(Reproducibility, AStateReadAndSetAgainContinuesBitForBit) {
  const Robot robot = bodies::voxels({.x = 3, .y = 3, .z = 3}, {60, 0, 0, 0});
  Simulation whole(configuration(), {&robot, 1});
  const State start = bodies::shaken(robot, 0.01f, 0.3f, 9);
  whole.set_state(0, start.positions, start.velocities);
  whole.step(100);
  Simulation continued(configuration(), {&robot, 1});
  const State middle = whole.state(0);
  continued.set_state(0, middle.positions, middle.velocities);
  whole.step(100);
  continued.step(100);
  EXPECT_EQ(continued.hash(0), whole.hash(0));
}

// 8,000 masses do not fit on a chip; whatever path they take keeps the promises.
TEST_P(Reproducibility, HoldsForARobotTooLargeForTheChip) {
  const std::vector<Robot> robots = {bodies::random_voxels({.x = 2, .y = 2, .z = 2}, 1),
                                     bodies::random_voxels({.x = 19, .y = 19, .z = 19}, 2)};
  Simulation together(configuration(), robots), alone(configuration(), std::span(robots).last(1));
  together.step(60);
  for (int call = 0; call < 60; ++call) alone.step();
  EXPECT_EQ(together.hash(1), alone.hash(0));
  Simulation small(configuration(), std::span(robots).first(1));
  small.step(60);
  EXPECT_EQ(together.hash(0), small.hash(0));
}

}  // namespace
}  // namespace mercury
