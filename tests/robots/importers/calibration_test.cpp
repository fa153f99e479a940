// SPDX-License-Identifier: Apache-2.0
// Bars of Mercury's springs against the theory of the beams that they stand for: first longitudinal frequency, stretch
// by their own weight, drag, and the time step at which they are stable.
#include "robots/importers/calibration.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>
#include <vector>

#include "mercury/voxel.h"
#include "tests/refusal.h"
#include "tests/sim/backend.h"

namespace mercury {
namespace {

using std::numbers::pi;

// As evosoro's sample robots have it, with voxels of 1 cm.
constexpr BeamModel soft{.elastic_modulus = 1e5, .density = 1200, .edge = 0.01};
constexpr int exact_thickness = BeamModel{}.thickness;

// A standing bar of `thickness` x `thickness` x `length` voxels.
Robot bar(int thickness, int length, double stiffness) {
  const auto defaults = default_materials();
  std::vector<Material> table(defaults.begin(), defaults.end());
  table[tissue] = {.stiffness = static_cast<float>(stiffness)};
  return make_voxel_robot(VoxelGrid(thickness, thickness, length, tissue), {.materials = table});
}

// The layer of each mass of such a bar, from 0 at the bottom.
std::vector<int> layers_of(const Robot& robot) {
  float lowest = robot.masses[0].z;
  for (const Vec3& mass : robot.masses) lowest = std::min(lowest, mass.z);
  std::vector<int> layers;
  for (const Vec3& mass : robot.masses)
    layers.push_back(static_cast<int>(std::lround(static_cast<double>(mass.z - lowest) / calibrated_edge)));
  return layers;
}

// The frequency of a free chain of equal masses, by the square of the frequency of two of them [rad/s].
double chain_frequency(double squared_rate, int masses) {
  return 2 * std::sqrt(squared_rate) * std::sin(pi / 2 / masses);
}

// Of the beams: mass density edge^3, stiffness E edge.
double beam_rate(const BeamModel& model) { return model.elastic_modulus / (model.density * model.edge * model.edge); }

class CalibratedBar : public BackendTest {
 protected:
  // The first longitudinal frequency of a free bar of springs in empty space [rad/s]. It begins at rest, deformed as
  // its first mode, and is projected on that mode.
  double measured_frequency(const Robot& robot, int length, const Calibration& calibration, double expected) const {
    const std::vector<int> layers = layers_of(robot);
    const auto mode = [&](std::size_t i) { return std::cos(pi * (layers[i] + 0.5) / (length + 1)); };
    const double amplitude = 1e-3 * length * calibrated_edge / pi;  // a strain of 1e-3
    Simulation simulation({.dt = calibration.time_step, .damping = 0, .environment = empty_space(), .device = device()},
                          {&robot, 1});
    std::vector<Vec3> positions = robot.masses;
    for (std::size_t i = 0; i < positions.size(); ++i) positions[i].z += static_cast<float>(amplitude * mode(i));
    simulation.set_state(0, positions, std::vector<Vec3>(positions.size()));
    const auto along_mode = [&] {
      const std::vector<Vec3> now = simulation.positions(0);
      double sum = 0;
      for (std::size_t i = 0; i < now.size(); ++i)
        sum += (static_cast<double>(now[i].z) - static_cast<double>(robot.masses[i].z)) * mode(i);
      return sum;
    };
    // Times at which it passes through its rest shape, half a period apart.
    std::vector<double> crossings;
    double last = along_mode();
    const double end = 3.4 * 2 * pi / expected;
    while (simulation.time() < end) {
      const double before = simulation.time();
      simulation.step();
      const double now = along_mode();
      if (last * now < 0) crossings.push_back(before + (simulation.time() - before) * last / (last - now));
      last = now;
    }
    if (crossings.size() < 2) return 0;
    return pi * static_cast<double>(crossings.size() - 1) / (crossings.back() - crossings.front());
  }

  // By how much a standing bar is shorter by its weight, as a share of its length.
  double measured_shortening(const Robot& robot, int length, const Calibration& calibration, double frequency) const {
    const Land land{.gravity = {0, 0, -static_cast<float>(calibration.gravity)},
                    .friction = 0,
                    .self_collision = false,
                    .stiffness_scale = 1};
    // The frequency of a bar that stands is half of that of a free one. This damping is critical for it.
    Simulation simulation({.dt = calibration.time_step, .damping = frequency, .environment = land, .device = device()},
                          {&robot, 1});
    simulation.step(std::llround(30 / frequency / calibration.time_step));
    const std::vector<int> layers = layers_of(robot);
    const std::vector<Vec3> now = simulation.positions(0);
    double top = 0, count = 0;
    for (std::size_t i = 0; i < now.size(); ++i)
      if (layers[i] == length) top += static_cast<double>(now[i].z), ++count;
    return 1 - top / count / (length * calibrated_edge);
  }
};
INSTANTIATE_TEST_SUITE_P(All, CalibratedBar, every_device, BackendTest::name);

// A bar of N voxels has N + 1 layers of masses here, where the beams have N masses in a row: its first frequency is
// that of a chain of N + 1. It narrows as it gets longer, and the inertia of that lowers the frequency by (0.35 r pi /
// L)^2 / 2, where r is the radius of gyration of the cross-section: 0.4 % for 4 x 4 x 24 voxels, the largest of these.
// At its ends a bar is stiffer across, which is a part of 1 / N of the length.
TEST_P(CalibratedBar, HasTheFirstLongitudinalFrequencyOfItsBeams) {
  for (const std::optional<double> time_scale : {std::optional<double>{}, std::optional<double>(2.5)})
    for (const int length : {24, 48}) {
      const Calibration calibration = calibrate(soft, time_scale);
      const Robot robot = bar(exact_thickness, length, soft.elastic_modulus * calibration.stiffness_per_modulus);
      const double rate = beam_rate(soft) / (calibration.time_scale * calibration.time_scale);
      const double of_layers = chain_frequency(rate, length + 1), of_beams = chain_frequency(rate, length);
      const double found = measured_frequency(robot, length, calibration, of_beams);
      EXPECT_NEAR(found / of_layers, 1, 0.15 / length) << length;
      EXPECT_NEAR(found / of_beams, length / (length + 1.0), 0.15 / length) << length;
    }
}

TEST_P(CalibratedBar, OfAnotherThicknessIsOffAsItsSlicesAre) {
  constexpr int length = 24;
  const Calibration calibration = calibrate(soft);
  for (const int thickness : {1, 2, 6}) {
    const Robot robot = bar(thickness, length, soft.elastic_modulus * calibration.stiffness_per_modulus);
    const double rate = beam_rate(soft) * slice_stiffness(thickness) / slice_stiffness(exact_thickness);
    const double expected = chain_frequency(rate, length + 1);
    // (0.35 r pi / L)^2 / 2 for 6 x 6 is 0.8 %.
    EXPECT_NEAR(measured_frequency(robot, length, calibration, expected) / expected, 1, 0.01) << thickness;
    BeamModel model = soft;
    model.thickness = thickness;
    const Calibration exact = calibrate(model);
    EXPECT_NEAR(exact.stiffness_per_modulus / calibration.stiffness_per_modulus,
                slice_stiffness(exact_thickness) / slice_stiffness(thickness), 1e-12);
  }
}

// Beams: N masses, of which the lowest is held: the i-th link carries N - i of them. As a share of the length between
// the first and the last that is density edge g N / (2 E). With N + 1 layers it is N + 1 in place of N.
TEST_P(CalibratedBar, IsShortenedByItsWeightAsItsBeams) {
  constexpr int length = 24;
  BeamModel model = soft;
  model.gravity = 2e-3 * model.elastic_modulus / (model.density * model.edge * length);  // a strain of 1e-3 in the mean
  const double of_beams = model.density * model.edge * model.gravity * length / (2 * model.elastic_modulus);
  for (const std::optional<double> time_scale :
       {std::optional<double>{}, std::optional<double>(gravity_time_scale(model.edge))}) {
    const Calibration calibration = calibrate(model, time_scale);
    const Robot robot = bar(exact_thickness, length, model.elastic_modulus * calibration.stiffness_per_modulus);
    const double frequency = chain_frequency(beam_rate(model), length) / calibration.time_scale;
    const double found = measured_shortening(robot, length, calibration, frequency);
    EXPECT_NEAR(found / of_beams, (length + 1.0) / length, 0.01);
  }
}

// evosoro: -c A v^2 on the face that goes ahead, on a mass of density edge^3 per voxel. Here there is a layer of masses
// more.
TEST_P(CalibratedBar, IsSlowedByWaterAsItsBeams) {
  constexpr int length = 24;
  const BeamModel model{.elastic_modulus = 1e6, .density = 1200, .edge = 0.05, .aggregate_drag = 750};
  const Calibration calibration = calibrate(model);
  const Robot robot = bar(exact_thickness, length, model.elastic_modulus * calibration.stiffness_per_modulus);
  const ResistiveDrag water{.normal_coefficient = static_cast<float>(calibration.drag_coefficient),
                            .tangential_coefficient = 0,
                            .added_mass_coefficient = 0,
                            .one_sided = true};
  const double dt = calibration.time_step, speed = 2;  // [m/s]
  Simulation simulation({.dt = dt, .damping = 0, .environment = {.water = water}, .device = device()}, {&robot, 1});
  simulation.set_state(0, robot.masses, std::vector<Vec3>(robot.masses.size(), {0, 0, static_cast<float>(speed)}));
  simulation.step();
  const double slowed = (speed - static_cast<double>(simulation.telemetry(0).velocity.z)) / dt;
  const double speed_there = speed / calibration.length_scale * calibration.time_scale;
  const double slowed_there = model.aggregate_drag * speed_there * speed_there / (model.density * model.edge * length);
  const double expected = slowed_there * calibration.length_scale / std::pow(calibration.time_scale, 2);
  EXPECT_NEAR(slowed / expected, length / (length + 1.0), 2e-3);
}

// A block of 8 layers has waves that are a little slower than those of an endless lattice: cos(pi / 16) of their
// highest frequency.
TEST_P(CalibratedBar, IsStableUpToTheLargestTimeStep) {
  const Calibration calibration = calibrate(soft);
  const Robot robot = bar(7, 7, soft.elastic_modulus * calibration.stiffness_per_modulus);
  for (const auto& [share, stable] : {std::pair(0.97, true), std::pair(1.1, false)}) {
    Simulation simulation(
        {.dt = share * calibration.largest_time_step, .damping = 0, .environment = empty_space(), .device = device()},
        {&robot, 1});
    std::vector<Vec3> positions = robot.masses;
    for (std::size_t i = 0; i < positions.size(); ++i) positions[i].x += i % 3 == 0 ? 1e-4f : -0.5e-4f;
    simulation.set_state(0, positions, std::vector<Vec3>(positions.size()));
    simulation.step(3000);
    const Telemetry end = simulation.telemetry(0);
    EXPECT_EQ(!end.exploded && end.largest_strain < 0.1f, stable) << share;
  }
}

TEST(Calibration, SliceStiffnessIsThatOfTheLattice) {
  EXPECT_DOUBLE_EQ(slice_stiffness(0), 2.7);
  EXPECT_DOUBLE_EQ(slice_stiffness(1), 22.0 / 13);
  EXPECT_NEAR(slice_stiffness(100'000), 2.7, 1e-4);
  for (int n = 1; n < 30; ++n) EXPECT_LT(slice_stiffness(n), slice_stiffness(n + 1)) << n;
}

TEST(Calibration, SlowsTimeOnlyWhereTheStepWouldBeTooShort) {
  const Calibration there = calibrate(soft);
  EXPECT_EQ(there.time_scale, 1);
  EXPECT_EQ(there.length_scale, 10);
  EXPECT_DOUBLE_EQ(there.gravity, 98.1);
  EXPECT_LE(there.time_step, there.largest_time_step / 3);
  BeamModel stiff = soft;
  stiff.elastic_modulus = 1e9;
  const Calibration slowed = calibrate(stiff);
  EXPECT_GT(slowed.time_scale, 1);
  EXPECT_DOUBLE_EQ(slowed.time_step, 1e-4);
  EXPECT_NEAR(slowed.largest_time_step, 3e-4, 1e-9);
  // Stretch by weight: gravity and stiffness slow down together.
  const Calibration at_once = calibrate(stiff, 1.0);
  EXPECT_NEAR(slowed.gravity / slowed.stiffness_per_modulus, at_once.gravity / at_once.stiffness_per_modulus,
              1e-9 * at_once.gravity / at_once.stiffness_per_modulus);
  EXPECT_DOUBLE_EQ(calibrate(soft, gravity_time_scale(soft.edge)).gravity, 9.81);
}

TEST(Calibration, DampingAndContactsFollowTheMassOnABeam) {
  BeamModel model = soft;
  model.slow_damping = 0.01;
  const double rate = std::sqrt(beam_rate(model));
  EXPECT_DOUBLE_EQ(calibrate(model, 1.0).damping, 0.02 * rate);
  EXPECT_DOUBLE_EQ(calibrate(model, 4.0).damping, 0.02 * rate / 4);
  EXPECT_DOUBLE_EQ(calibrate(model, 4.0).contact_stiffness, rate * rate / 16);
}

TEST(Calibration, RefusesNumbersThatNoBodyHas) {
  constexpr double infinity = std::numeric_limits<double>::infinity(), nan = std::numeric_limits<double>::quiet_NaN();
  const auto refused = [](const BeamModel& model, std::optional<double> scale = {}) {
    return refusal([&] { calibrate(model, scale); });
  };
  for (const double odd : {0.0, -1.0, infinity, nan}) {
    EXPECT_EQ(refused({.elastic_modulus = odd}), "elastic modulus: must be a finite number above 0");
    EXPECT_EQ(refused({.density = odd}), "density: must be a finite number above 0");
    EXPECT_EQ(refused({.edge = odd}), "edge: must be a finite number above 0");
    EXPECT_EQ(refused({}, odd), "time scale: must be a finite number above 0");
    EXPECT_EQ(refused({.gravity = odd}), odd == 0 ? "" : "gravity: must be a finite number of at least 0");
  }
  EXPECT_EQ(refused({.thickness = -1}), "thickness: must be at least 0 voxels");
  for (const double huge : {1e-300, 1e-160, 1e160, 1e300})
    EXPECT_NE(refused({.elastic_modulus = huge, .density = 1 / huge}), "") << huge;
  EXPECT_NE(refused({.gravity = 1e300}), "");
  EXPECT_EQ(refused({}), "");
}

}  // namespace
}  // namespace mercury
