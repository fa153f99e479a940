// SPDX-License-Identifier: Apache-2.0
// A robot that explodes is frozen and reported. The others go on as if it were not there.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "backend.h"
#include "bodies.h"
#include "sim/physics/muscle.h"

namespace mercury {
namespace {

class Explosion : public EveryPair {
 protected:
  static std::vector<Robot> three() {
    return {bodies::random_voxels({}, 1), bodies::random_voxels({.x = 3, .y = 3, .z = 3}, 2),
            bodies::random_voxels({.x = 4, .y = 2, .z = 3}, 3)};
  }
  static constexpr std::uint16_t victim = 20;
  // The state of the middle robot with one mass moved or pushed.
  static State mistreated(const Simulation& simulation, Vec3 position, Vec3 velocity) {
    State state = simulation.state(1);
    state.positions[victim] = position;
    state.velocities[victim] = velocity;
    return state;
  }
};
INSTANTIATE_TEST_SUITE_P(All, Explosion, every_pair, EveryPair::name);

TEST_P(Explosion, IsReportedWithTimeAndCulpritAndFreezesOnlyThatRobot) {
  const auto robots = three();
  const float infinity = std::numeric_limits<float>::infinity(), nan = std::numeric_limits<float>::quiet_NaN();
  const Vec3 rest = robots[1].masses[victim];
  const std::vector<std::pair<Vec3, Vec3>> ways = {{rest, {1e10f, 0, 0}}, {rest, {0, 0, infinity}}, {rest, {0, nan, 0}},
                                                   {{2e6f, 0, 0}, {}},    {{0, nan, 0}, {}},        {{0, 500, 1}, {}}};
  for (std::size_t way = 0; way < ways.size(); ++way) {
    Simulation simulation(configuration(), robots), undisturbed(configuration(), robots);
    simulation.step(50);
    undisturbed.step(250);
    const State state = mistreated(simulation, ways[way].first, ways[way].second);
    simulation.set_state(1, state.positions, state.velocities);
    EXPECT_FALSE(simulation.telemetry(1).exploded);
    simulation.step(100);
    const Telemetry telemetry = simulation.telemetry(1);
    ASSERT_TRUE(telemetry.exploded) << "way " << way;
    EXPECT_NEAR(telemetry.exploded_at, 0.05, 1.001e-3) << "way " << way;  // in the very next step
    ASSERT_LT(telemetry.culprit_spring, robots[1].springs.size());
    const Spring& bad = robots[1].springs[telemetry.culprit_spring];
    EXPECT_TRUE(bad.a == victim || bad.b == victim) << "way " << way << ": " << bad.a << " - " << bad.b;
    const bool torn = std::isfinite(state.positions[victim].y) && state.positions[victim].y == 500;
    const auto strain = [&](const Spring& spring) {
      return length(state.positions[spring.b] - state.positions[spring.a]) / spring.rest_length;
    };
    for (std::uint32_t other = 0; other < robots[1].springs.size(); ++other) {
      const Spring& spring = robots[1].springs[other];
      if (torn) {
        EXPECT_LE(strain(spring), 1.001f * strain(bad)) << "not the most strained";
      } else if (other < telemetry.culprit_spring) {
        EXPECT_FALSE(spring.a == victim || spring.b == victim) << "not the first";
      }
    }

    const std::uint64_t frozen = simulation.hash(1);
    simulation.step(100);
    EXPECT_EQ(simulation.hash(1), frozen) << "way " << way;
    EXPECT_EQ(simulation.telemetry(1).exploded_at, telemetry.exploded_at);
    for (const std::size_t neighbor : {0u, 2u}) {
      EXPECT_FALSE(simulation.telemetry(neighbor).exploded);
      EXPECT_EQ(simulation.hash(neighbor), undisturbed.hash(neighbor)) << "way " << way;
    }
  }
}

TEST_P(Explosion, EndsWithAResetOrANewState) {
  const auto robots = three();
  Simulation simulation(configuration(), robots), fresh(configuration(), robots);
  const State state = mistreated(simulation, {}, {1e10f, 0, 0});
  simulation.set_state(1, state.positions, state.velocities);
  simulation.step(10);
  ASSERT_TRUE(simulation.telemetry(1).exploded);
  simulation.reset();
  EXPECT_FALSE(simulation.telemetry(1).exploded);
  simulation.step(100);
  fresh.step(100);
  EXPECT_EQ(simulation.hash(1), fresh.hash(1));
}

TEST_P(Explosion, SurvivesAddingAnotherRobot) {
  const auto robots = three();
  Simulation simulation(configuration(), robots);
  const State state = mistreated(simulation, {}, {1e10f, 0, 0});
  simulation.set_state(1, state.positions, state.velocities);
  simulation.step(10);
  const Telemetry before = simulation.telemetry(1);
  const std::uint64_t frozen = simulation.hash(1);
  simulation.add(robots[0]);
  simulation.step(10);
  EXPECT_TRUE(simulation.telemetry(1).exploded);
  EXPECT_EQ(simulation.telemetry(1).exploded_at, before.exploded_at);
  EXPECT_EQ(simulation.hash(1), frozen);
}

TEST_P(Explosion, KeepsItsTimeWhenTheTimeStepChanges) {
  for (const bool asked_before : {true, false}) {
    const auto robots = three();
    Simulation simulation(configuration(), robots);
    simulation.step(50);
    const State state = mistreated(simulation, {}, {1e10f, 0, 0});
    simulation.set_state(1, state.positions, state.velocities);
    simulation.step(30);
    if (asked_before) {
      EXPECT_NEAR(simulation.telemetry(1).exploded_at, 0.05, 1.001e-3);
    }
    Configuration finer = configuration();
    finer.dt /= 4;
    simulation.configure(finer);
    simulation.step(10);
    EXPECT_NEAR(simulation.telemetry(1).exploded_at, 0.05, 1.001e-3);
  }
}

TEST_P(Explosion, IsPartOfAStateThatAnotherSimulationTakes) {
  const auto robots = three();
  Simulation simulation(configuration(), robots), other(configuration(), robots);
  const State state = mistreated(simulation, {}, {1e10f, 0, 0});
  simulation.set_state(1, state.positions, state.velocities);
  simulation.step(10);
  const State frozen = simulation.state(1);
  ASSERT_TRUE(frozen.exploded);
  other.step(25);
  other.set_state(1, frozen);
  const Telemetry after = other.telemetry(1), before = simulation.telemetry(1);
  EXPECT_TRUE(after.exploded);
  EXPECT_EQ(after.exploded_at, before.exploded_at);
  EXPECT_EQ(after.culprit_spring, before.culprit_spring);
  other.step(25);
  EXPECT_EQ(other.hash(1), simulation.hash(1)) << "it stays frozen";
  EXPECT_EQ(other.telemetry(1).exploded_at, before.exploded_at);
  other.set_state(1, state.positions, std::vector<Vec3>(state.positions.size()));
  EXPECT_FALSE(other.telemetry(1).exploded);
}

class Continuing : public EveryPair {};
INSTANTIATE_TEST_SUITE_P(All, Continuing, every_pair, EveryPair::name);

TEST_P(Continuing, FromAStateAndItsClockGivesTheSameBits) {
  const Robot robot = bodies::random_voxels({.x = 4, .y = 3, .z = 3}, 5);
  Simulation first(configuration(), std::span(&robot, 1));
  first.step(70);
  Configuration changed = configuration();
  changed.dt *= 0.7;
  first.configure(changed);
  first.step(31);
  Simulation second(changed, std::span(&robot, 1));
  second.set_clock(first.clock());
  second.set_state(0, first.state(0));
  EXPECT_EQ(second.time(), first.time());
  EXPECT_EQ(second.steps(), 101);
  first.step(500);
  second.step(500);
  EXPECT_EQ(second.hash(0), first.hash(0));
  EXPECT_EQ(second.time(), first.time());
  Clock wrong = first.clock();
  wrong.dt *= 2;
  EXPECT_THROW(second.set_clock(wrong), std::invalid_argument);
  wrong = first.clock();
  wrong.step = wrong.base_step - 1;
  EXPECT_THROW(second.set_clock(wrong), std::invalid_argument);
}

// omega_max of the pair is sqrt(2 k); beyond dt = 2 / omega_max the force solver's pair grows without bound.
class Stability : public BackendTest {};
INSTANTIATE_TEST_SUITE_P(All, Stability, every_device, BackendTest::name);

TEST_P(Stability, OfTheForceSolverEndsAtTwoOverOmegaAndXpbdIsStableBeyond) {
  const Robot pair = bodies::pair({50, 0, 0, 0});
  const double limit = 2 / std::sqrt(2 * 50.0);
  const auto explodes = [&](Solver solver, double dt) {
    Simulation simulation({.dt = dt, .damping = 0, .solver = solver, .environment = empty_space(), .device = device()},
                          {&pair, 1});
    simulation.set_state(0, std::vector<Vec3>{{0, 0, 0}, {1.01f, 0, 0}}, std::vector<Vec3>(2));
    simulation.step(2000);
    return simulation.telemetry(0).exploded;
  };
  EXPECT_FALSE(explodes(Solver::force, 0.98 * limit));
  EXPECT_TRUE(explodes(Solver::force, 1.02 * limit));
  for (const double factor : {0.98, 1.02, 2.0, 10.0, 1000.0})
    EXPECT_FALSE(explodes(Solver::xpbd, factor * limit)) << factor;
}

TEST_P(Stability, XpbdStaysBoundedAtTimeStepsWhereTheForceSolverExplodes) {
  const Robot robot = bodies::random_voxels({.x = 4, .y = 3, .z = 3}, 4);
  const std::vector<std::pair<std::string_view, double>> beyond = {
      {Ocean::name, 0.1}, {Ocean::name, 1},   {OceanSimple::name, 0.1}, {OceanSimple::name, 1},
      {Land::name, 0.01}, {Land::name, 0.05}, {Land::name, 0.1},        {Land::name, 0.2}};
  for (const auto& [environment, dt] : beyond) {
    Configuration configuration{.dt = dt, .environment = environment_named(environment), .device = device()};
    Simulation force(configuration, {&robot, 1});
    force.step(std::llround(20 / dt));
    EXPECT_TRUE(force.telemetry(0).exploded) << environment << " dt " << dt;
    configuration.solver = Solver::xpbd;
    Simulation xpbd(configuration, {&robot, 1});
    for (int look = 0; look < 20; ++look) {
      xpbd.step(std::llround(1 / dt));
      const Telemetry telemetry = xpbd.telemetry(0);
      ASSERT_FALSE(telemetry.exploded) << environment << " dt " << dt;
      ASSERT_LT(telemetry.largest_strain, 1.2) << environment << " dt " << dt << " at " << xpbd.time() << " s";
    }
  }
}

}  // namespace
}  // namespace mercury
