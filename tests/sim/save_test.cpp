// SPDX-License-Identifier: Apache-2.0
// Simulation::save() and restore(): whatever happens in between, the robots go on as they did before.
#include <gtest/gtest.h>

#include "backend.h"
#include "bodies.h"
#include "mixed_robots.h"

namespace mercury {
namespace {

class Save : public EveryPair {};
INSTANTIATE_TEST_SUITE_P(All, Save, every_pair, EveryPair::name);

TEST_P(Save, RobotsGoOnAsTheyDidBefore) {
  const std::vector<Robot> robots = test::mixed_robots(8);
  Simulation simulation(configuration(), robots);
  simulation.step(137);
  const std::vector<std::uint64_t> then = simulation.hashes();
  const BatchState state = simulation.save();
  simulation.step(200);
  const std::vector<std::uint64_t> later = simulation.hashes();
  const double time = simulation.time();
  simulation.restore(state);
  EXPECT_EQ(simulation.steps(), 137);
  EXPECT_EQ(simulation.hashes(), then);
  simulation.step(1);
  simulation.step(199);
  EXPECT_EQ(simulation.hashes(), later);
  EXPECT_EQ(simulation.time(), time);
}

TEST_P(Save, AnotherSimulationGoesOnFromThere) {
  const std::vector<Robot> robots = test::mixed_robots(4);
  Simulation first(configuration(), robots);
  first.step(50);
  Simulation second(configuration(), robots);
  second.restore(first.save());
  first.step(100);
  second.step(100);
  EXPECT_EQ(second.hashes(), first.hashes());
}

class SaveOn : public BackendTest {};
INSTANTIATE_TEST_SUITE_P(All, SaveOn, every_device, BackendTest::name);

TEST_P(SaveOn, PhasesGoOnAfterAChangeOfTheTimeStep) {
  Configuration configuration{.device = device()};
  Simulation simulation(configuration, test::growing_robots(3));
  simulation.step(100);
  configuration.dt = 0.0007;
  simulation.configure(configuration);
  simulation.step(33);
  const BatchState state = simulation.save();
  simulation.step(100);
  const std::vector<std::uint64_t> later = simulation.hashes();
  simulation.restore(state);
  EXPECT_EQ(simulation.clock().base_step, 100);
  simulation.step(100);
  EXPECT_EQ(simulation.hashes(), later);
}

// Robot 1 explodes between the two states.
TEST_P(SaveOn, AnExplosionIsUndoneAndDoneAgain) {
  Simulation simulation({.environment = empty_space(), .device = device()}, test::growing_robots(3));
  State fast = simulation.state(1);
  fast.velocities[0].x = 1e5f;
  simulation.set_state(1, fast);
  const BatchState sound = simulation.save();
  EXPECT_TRUE(sound.explosions.empty());
  simulation.step(30'000);
  const BatchState exploded = simulation.save();
  ASSERT_EQ(exploded.explosions.size(), 1u);
  EXPECT_EQ(exploded.explosions[0].robot, 1u);
  const Telemetry then = simulation.telemetry(1);
  ASSERT_TRUE(then.exploded);

  simulation.restore(sound);
  EXPECT_FALSE(simulation.telemetry(1).exploded);
  simulation.step(30'000);
  EXPECT_EQ(simulation.telemetry(1).exploded_at, then.exploded_at);

  simulation.restore(sound);
  simulation.restore(exploded);
  EXPECT_TRUE(simulation.telemetry(1).exploded);
  EXPECT_EQ(simulation.telemetry(1).exploded_at, then.exploded_at);
  EXPECT_EQ(simulation.telemetry(1).culprit_spring, then.culprit_spring);
  const std::uint64_t frozen = simulation.hash(1), moving = simulation.hash(0);
  simulation.step(10);
  EXPECT_EQ(simulation.hash(1), frozen);
  EXPECT_NE(simulation.hash(0), moving);
}

TEST_P(SaveOn, AStateThatDoesNotFitIsRefusedAndChangesNothing) {
  Simulation simulation({.device = device()}, test::growing_robots(3));
  simulation.step(10);
  const std::vector<std::uint64_t> before = simulation.hashes();
  const BatchState good = simulation.save();
  BatchState bad = good;
  bad.positions.pop_back();
  EXPECT_THROW(simulation.restore(bad), std::invalid_argument);
  bad = good;
  bad.clock.dt = 0.5;
  EXPECT_THROW(simulation.restore(bad), std::invalid_argument);
  bad = good;
  bad.clock.base_step = 11;
  EXPECT_THROW(simulation.restore(bad), std::invalid_argument);
  bad = good;
  bad.explosions = {{.robot = 3}};
  EXPECT_THROW(simulation.restore(bad), std::invalid_argument);
  EXPECT_EQ(simulation.hashes(), before);
}

}  // namespace
}  // namespace mercury
