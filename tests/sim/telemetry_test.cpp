// SPDX-License-Identifier: Apache-2.0
// Telemetry against an independent calculation, and other ways to read a batch.
#include "mercury/telemetry.h"

#include <gtest/gtest.h>

#include <cstring>

#include "backend.h"
#include "bodies.h"
#include "mercury/observables.h"
#include "reference.h"
#include "same_telemetry.h"

namespace mercury {
namespace {

class TelemetryOf : public EveryPair {};
INSTANTIATE_TEST_SUITE_P(All, TelemetryOf, every_pair, EveryPair::name);

// The power of the muscles changes by at most this if every spring is longer by `length` [W].
double power_of(double length, const Configuration& configuration, const Robot& robot) {
  double sum = 0;
  for (const Spring& spring : robot.springs) {
    const MaterialNow now = material_at(materials_of(robot)[spring.material], configuration.environment, {});
    const Material& material = materials_of(robot)[spring.material];
    sum += double{now.stiffness * spring.rest_length * material.amplitude * material.frequency};
  }
  return length * sum;
}

TEST_P(TelemetryOf, AMovingRobotAgreesWithAnIndependentCalculation) {
  const std::vector<Robot> robots = {bodies::random_voxels({}, 1), bodies::random_voxels({.x = 3, .y = 1, .z = 2}, 2),
                                     bodies::point({1, 2, 3}), bodies::pair({50, 0.3f, 4, 1}),
                                     bodies::with_half_waves(bodies::random_voxels({}, 4))};
  Simulation simulation(configuration(), robots);
  for (std::size_t i = 0; i < robots.size(); ++i) {
    const State start = bodies::shaken(robots[i], 0.01f, 0.2f, 3);
    simulation.set_state(i, start.positions, start.velocities);
  }
  for (int look = 0; look < 3; ++look) {
    simulation.step(100);
    const auto all = simulation.telemetry();
    ASSERT_EQ(all.size(), robots.size());
    for (std::size_t i = 0; i < robots.size(); ++i) {
      reference::Reference expected(configuration(), robots[i]);
      expected.step(simulation.steps());  // for its clock
      expected.set_state(simulation.state(i));
      const Telemetry& telemetry = all[i];
      EXPECT_LT((reference::vector_of(telemetry.center_of_mass) - expected.center_of_mass()).norm(), 1e-6) << i;
      EXPECT_LT((reference::vector_of(telemetry.velocity) - expected.center_velocity()).norm(), 1e-6) << i;
      EXPECT_NEAR(telemetry.kinetic_energy, expected.kinetic_energy(), 1e-5 * expected.kinetic_energy() + 1e-12) << i;
      EXPECT_NEAR(telemetry.elastic_energy, expected.elastic_energy(), 1e-3 * expected.elastic_energy() + 1e-12) << i;
      // The positions are rounded to 1e-7 m.
      EXPECT_NEAR(telemetry.muscle_power, expected.muscle_power(), power_of(1e-6, configuration(), robots[i])) << i;
      EXPECT_NEAR(telemetry.largest_strain, expected.largest_strain(), 1e-5) << i;
      EXPECT_FALSE(telemetry.exploded);
      EXPECT_EQ(telemetry.culprit_spring, no_spring);
      const Telemetry one = simulation.telemetry(i);
      EXPECT_EQ(one.kinetic_energy, telemetry.kinetic_energy);
      EXPECT_EQ(one.center_of_mass, telemetry.center_of_mass);
    }
  }
}

TEST_P(TelemetryOf, SpringsOfMoreThanHalfStrainAreCounted) {
  const std::vector<Robot> robots = {bodies::random_voxels({.x = 6, .y = 4, .z = 4}, 1), bodies::point(),
                                     bodies::random_voxels({.x = 1, .y = 1, .z = 1}, 2)};
  Simulation simulation(configuration(), robots);
  for (std::size_t i = 0; i < robots.size(); ++i) {
    const State start = bodies::shaken(robots[i], 0.05f, 0.2f, 3);
    simulation.set_state(i, start.positions, start.velocities);
  }
  for (int look = 0; look < 2; ++look) {
    const std::vector<Telemetry> telemetry = simulation.telemetry();
    EXPECT_GT(telemetry[0].strained_share, 0.01f);
    EXPECT_EQ(telemetry[1].strained_share, 0);
    for (std::size_t i = 0; i < robots.size(); ++i) {
      reference::Reference expected(configuration(), robots[i]);
      expected.set_state(simulation.state(i));
      const double springs = static_cast<double>(robots[i].springs.size());
      const double share = double{telemetry[i].strained_share};
      // Rounding decides about springs at the limit.
      EXPECT_LE(share * springs, static_cast<double>(expected.springs_beyond(0.5 - 1e-5)) + 1e-3) << i;
      EXPECT_GE(share * springs, static_cast<double>(expected.springs_beyond(0.5 + 1e-5)) - 1e-3) << i;
      EXPECT_LT(share, 0.9) << i;
    }
    simulation.step(1);
  }
}

// Backends may compute the next report while they step. It must show changes that come after that.
TEST_P(TelemetryOf, ARobotShowsItsPresentState) {
  const Robot robot = bodies::random_voxels({}, 1);
  Simulation simulation(configuration(), {&robot, 1});
  const State start = bodies::shaken(robot, 0.01f, 0.2f, 3);
  simulation.set_state(0, start.positions, start.velocities);
  simulation.step(10);
  (void)simulation.telemetry();
  simulation.step(10);
  const State still{simulation.positions(0), std::vector<Vec3>(robot.masses.size())};
  simulation.set_state(0, still.positions, still.velocities);
  EXPECT_EQ(simulation.telemetry(0).kinetic_energy, 0);

  simulation.step(10);
  const double soft = simulation.telemetry(0).elastic_energy;
  for (std::size_t id = 1; id < default_materials().size(); ++id) {
    Material material = simulation.material(0, static_cast<MaterialId>(id));
    material.stiffness *= 2;
    simulation.set_material(0, static_cast<MaterialId>(id), material);
  }
  EXPECT_NEAR(simulation.telemetry(0).elastic_energy, 2 * soft, 1e-5 * soft);
}

// It does not depend on whether the report is computed while stepping, or on the other robots of the batch.
TEST_P(TelemetryOf, ARobotIsTheSameBitForBitInAnyBatch) {
  const Robot robot = bodies::random_voxels({}, 1);
  const State start = bodies::shaken(robot, 0.01f, 0.2f, 3);
  const auto report = [&](std::vector<Robot> robots, int calls) {
    Simulation simulation(configuration(), robots);
    simulation.set_state(0, start.positions, start.velocities);
    Telemetry last;
    for (int call = 0; call < calls; ++call) {
      simulation.step(60 / calls);
      last = simulation.telemetry(0);
    }
    return last;
  };
  const Telemetry once = report({robot}, 1);
  const std::vector<Robot> several = {robot, bodies::random_voxels({.x = 9, .y = 8, .z = 7}, 2),
                                      bodies::point({1, 2, 3}), bodies::pair({50, 0.3f, 4, 1})};
  for (const Telemetry& other : {report({robot}, 3), report(several, 1), report(several, 4)}) {
    expect_equal(other, once);
  }
}

class Reading : public BackendTest {};
INSTANTIATE_TEST_SUITE_P(All, Reading, every_device, BackendTest::name);

TEST_P(Reading, AllMassesAtOnceAgreesWithRobotByRobot) {
  const std::vector<Robot> robots = {bodies::random_voxels({}, 1), bodies::point(),
                                     bodies::random_voxels({.x = 1, .y = 1, .z = 1}, 2)};
  Simulation simulation({.device = {.kind = GetParam()}}, robots);
  simulation.step(200);
  ASSERT_EQ(simulation.mass_count(), 216u + 1 + 8);
  const auto offsets = simulation.mass_offsets();
  ASSERT_EQ(offsets.size(), 4u);
  std::vector<Vec3> x(simulation.mass_count()), v(simulation.mass_count());
  simulation.read_positions(x);
  simulation.read_velocities(v);
  for (std::size_t i = 0; i < robots.size(); ++i) {
    const State state = simulation.state(i);
    ASSERT_EQ(state.positions.size(), offsets[i + 1] - offsets[i]);
    for (std::size_t m = 0; m < state.positions.size(); ++m) {
      EXPECT_EQ(x[offsets[i] + m], state.positions[m]);
      EXPECT_EQ(v[offsets[i] + m], state.velocities[m]);
    }
    EXPECT_EQ(simulation.positions(i), state.positions);
  }
  std::vector<Vec3> wrong(3);
  EXPECT_THROW(simulation.read_positions(wrong), std::invalid_argument);
  EXPECT_THROW(simulation.read_velocities(wrong), std::invalid_argument);
  EXPECT_THROW(simulation.state(3), std::out_of_range);
}

TEST_P(Reading, TheHashIsFnv1aOverTheBytesOfPositionsAndVelocities) {
  const Robot robot = bodies::random_voxels({.x = 2, .y = 2, .z = 2}, 5);
  Simulation simulation({.device = {.kind = GetParam()}}, {&robot, 1});
  simulation.step(50);
  const State state = simulation.state(0);
  std::uint64_t hash = 14695981039346656037u;
  for (const auto* list : {&state.positions, &state.velocities})
    for (const Vec3 value : *list)
      for (const float component : {value.x, value.y, value.z}) {
        unsigned char bytes[4];  // only little-endian machines are supported
        std::memcpy(bytes, &component, 4);
        for (const unsigned char byte : bytes) hash = (hash ^ byte) * 1099511628211u;
      }
  EXPECT_EQ(simulation.hash(0), hash);
}

}  // namespace
}  // namespace mercury
