// SPDX-License-Identifier: Apache-2.0
// The length of a muscle that a program drives: L = L0 (1 + amplitude u).
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <limits>
#include <numbers>

#include "bodies.h"
#include "mercury/observables.h"
#include "shared_batch.h"
#include "sim/physics/actuation.h"

namespace mercury {
namespace {

using test::SharedBatch;

constexpr float nan_value = std::numeric_limits<float>::quiet_NaN();
constexpr float infinity = std::numeric_limits<float>::infinity();

TEST(Arcsine, AgreesWithTheStandardLibrary) {
  for (int i = 0; i <= 100000; ++i) {
    const float u = static_cast<float>(i) * 1e-5f;
    const double expected = std::asin(static_cast<double>(u));
    // The polynomial is within 2e-8, and floats up to pi/2 are within 6e-8.
    ASSERT_NEAR(static_cast<double>(arcsine(u)), expected, 8e-8) << u;
    ASSERT_NEAR(static_cast<double>(arcsine(-u)), -expected, 8e-8) << u;
  }
}

TEST(Arcsine, EndsAtAQuarterTurn) {
  const auto quarter = static_cast<float>(std::numbers::pi / 2);
  EXPECT_EQ(arcsine(1), quarter);
  EXPECT_EQ(arcsine(-1), -quarter);
  EXPECT_EQ(arcsine(1.5f), quarter);
  EXPECT_EQ(arcsine(-3e38f), -quarter);
}

// At a time step of many minutes, an XPBD spring has its rest length after every step (muscle_test.cpp).
class DrivenLength : public test::SharedBatchTest {
 protected:
  static constexpr float amplitude = 0.9f;
  static Configuration configuration() {
    return {.dt = 997.3, .damping = 1, .solver = Solver::xpbd, .environment = empty_space()};
  }
  static double length_of(const Simulation& simulation, std::size_t robot) {
    const auto x = simulation.positions(robot);
    return static_cast<double>(length(x[1] - x[0]));
  }
};
INSTANTIATE_TEST_SUITE_P(All, DrivenLength, test::every_backend, test::SharedBatchTest::name);

TEST_P(DrivenLength, IsOnePlusAmplitudeTimesDrive) {
  const std::vector<float> drives = {-1, -0.75f, -0.1f, 0, 1e-3f, 0.5f, 0.99f, 1};
  const std::vector<Robot> robots(drives.size(), bodies::pair({50, amplitude, 3, 0.4f}));
  SharedBatch batch = this->batch(configuration(), robots);
  const Actuation& arrays = batch->actuation();
  batch.write(arrays.drive, drives);
  for (const int sign : {1, -1}) {
    batch->step();
    for (std::size_t i = 0; i < drives.size(); ++i)
      EXPECT_NEAR(length_of(*batch, i), 1 + sign * double{amplitude} * double{drives[i]}, 8e-6) << drives[i];
    for (std::size_t i = 0; i < drives.size(); ++i) batch.write(arrays.drive, i, 0, -drives[i]);
  }
}

TEST_P(DrivenLength, UsesAmplitudesAndLimitsThem) {
  const std::vector<Robot> robots(4, bodies::pair({50, amplitude, 3, 0.4f}));
  SharedBatch batch = this->batch(configuration(), robots);
  const Actuation& arrays = batch->actuation();
  batch.write(arrays.amplitude, {0.5f, -0.5f, 7, nan_value});
  batch.write(arrays.drive, {0.5f, 0.5f, 1, 4});
  batch->step();
  EXPECT_NEAR(length_of(*batch, 0), 1.25, 8e-6);
  EXPECT_NEAR(length_of(*batch, 1), 0.75, 8e-6);
  EXPECT_NEAR(length_of(*batch, 2), 2, 8e-6);
  EXPECT_NEAR(length_of(*batch, 3), 1 + double{amplitude}, 8e-6);
}

// A drive of NaN is none before the first number; frequencies and phases that are not finite are none.
TEST_P(DrivenLength, FollowsTheSineWithoutADrive) {
  const std::vector<float> drives(3, nan_value);
  const std::vector<Robot> robots(drives.size(), bodies::pair({50, amplitude, 3, 0.4f}));
  SharedBatch batch = this->batch(configuration(), robots);
  const Actuation& arrays = batch->actuation();
  batch.write(arrays.drive, drives);
  batch.write(arrays.frequency, {nan_value, 5, infinity});
  batch.write(arrays.phase, {2, -infinity, nan_value});
  batch->step(3);
  const double time = 2 * configuration().dt;  // the last step's beginning
  const auto expected = [&](double frequency, double phase) {
    return 1 + double{amplitude} * std::sin(frequency * time + phase);
  };
  EXPECT_NEAR(length_of(*batch, 0), expected(3, 2), 8e-6);
  EXPECT_NEAR(length_of(*batch, 1), expected(5, double{0.4f}), 8e-6);
  EXPECT_NEAR(length_of(*batch, 2), expected(3, double{0.4f}), 8e-6);
}

// One robot each with a drive, with a drive and an amplitude, with another sine, and as its file has it.
TEST_P(DrivenLength, IsWhatDrivenMaterialsSay) {
  const std::vector<Robot> robots(4, bodies::pair({50, amplitude, 3, 0.4f}));
  SharedBatch batch = this->batch(configuration(), robots);
  EXPECT_FALSE(batch->driven_materials().drives(0));
  const Actuation& arrays = batch->actuation();
  batch.write(arrays.drive, {-0.5f, 0.75f, nan_value, nan_value});
  batch.write(arrays.amplitude, {nan_value, 0.5f, 0.25f, nan_value});
  batch.write(arrays.frequency, {nan_value, nan_value, 5, nan_value});
  batch->step();
  const double begin = 0;  // of the step
  const DrivenMaterials driven = batch->driven_materials();
  for (std::size_t i = 0; i < robots.size(); ++i) {
    EXPECT_EQ(driven.drives(i), i < 2) << i;
    const auto now = materials_at(driven.of(i, materials_of(robots[i])), batch->configuration().environment, begin);
    EXPECT_NEAR(double{now[robots[i].springs[0].material].length_factor}, length_of(*batch, i), 8e-6) << i;
  }
  EXPECT_FALSE(driven.drives(robots.size()));
}

// Robot 1 has no second actuator: what is in its second column is ignored.
TEST_P(DrivenLength, ActuatorsDriveTheirOwnSpringsOnly) {
  Robot two = bodies::pair({50, amplitude, 3, 0.4f});
  two.masses.insert(two.masses.end(), {{0, 1, 0}, {1, 1, 0}});
  two.springs.push_back({2, 3, 1, 1});
  add_actuator(two, "lower", std::array{0u});
  add_actuator(two, "upper", std::array{1u});
  const std::vector<Robot> robots = {two, bodies::pair({50, amplitude, 3, 0.4f})};
  SharedBatch batch = this->batch(configuration(), robots);
  const Actuation& arrays = batch->actuation();
  batch.write(arrays.drive, {0.25f, -0.5f, 0.75f, -1});
  batch->step();
  const auto x = batch->positions(0);
  EXPECT_NEAR(static_cast<double>(length(x[1] - x[0])), 1 + 0.25 * double{amplitude}, 8e-6);
  EXPECT_NEAR(static_cast<double>(length(x[3] - x[2])), 1 - 0.5 * double{amplitude}, 8e-6);
  EXPECT_NEAR(length_of(*batch, 1), 1 + 0.75 * double{amplitude}, 8e-6);
}

}  // namespace
}  // namespace mercury
