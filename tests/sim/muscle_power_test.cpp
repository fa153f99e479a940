// SPDX-License-Identifier: Apache-2.0
// The work of the muscles against the energy of the body: what goes in is there, or drag and damping have taken it.
#include <gtest/gtest.h>

#include <algorithm>

#include "backend.h"
#include "bodies.h"

namespace mercury {
namespace {

class MusclePower : public BackendTest {};
INSTANTIATE_TEST_SUITE_P(All, MusclePower, every_device, BackendTest::name);

constexpr double seconds = 5;

struct Balance {
  double work = 0;     // of the muscles, trapezoid rule over all steps [J]
  double gained = 0;   // by which kinetic and elastic energy grew [J]
  double moved = 0;    // integral of twice the kinetic energy [J s]
  double largest = 0;  // kinetic and elastic energy [J]
};

// The velocity after step n is (x^n - x^(n-1)) / dt, which is that of half a step earlier. So the kinetic energy at the
// time of step n is the mean of those after steps n and n + 1, and the balance is of second order in dt.
Balance balance(const Configuration& configuration, const Robot& robot) {
  Simulation simulation(configuration, {&robot, 1});
  const double dt = configuration.dt;
  const auto steps = static_cast<std::int64_t>(seconds / dt);
  const Telemetry start = simulation.telemetry(0);
  std::vector<Telemetry> samples = simulation.step_and_sample(steps + 1, 1);
  samples.insert(samples.begin(), start);
  const auto kinetic = [&](std::size_t n) { return (samples[n].kinetic_energy + samples[n + 1].kinetic_energy) / 2; };
  const auto energy = [&](std::size_t n) { return kinetic(n) + samples[n].elastic_energy; };
  Balance result;
  const std::size_t last = samples.size() - 2;
  for (std::size_t n = 0; n < last; ++n) {
    result.work += dt * (samples[n].muscle_power + samples[n + 1].muscle_power) / 2;
    result.moved += dt * (kinetic(n) + kinetic(n + 1));
    result.largest = std::max(result.largest, energy(n + 1));
  }
  result.gained = energy(last) - energy(0);
  return result;
}

// (omega dt)^2, with the fastest oscillation that the springs allow: omega^2 <= 2 k (springs at a mass), 26 springs of
// at most 100 N/m. The relative error of the scheme's energy is a fraction of this.
double second_order(double dt) { return 2 * 100.0 * 26 * dt * dt; }

TEST_P(MusclePower, WithoutDragTheWorkOfTheMusclesIsTheEnergyThatTheBodyGains) {
  const Robot robot = bodies::random_voxels({.x = 3, .y = 2, .z = 2}, 1);
  for (const double dt : {1e-3, 2.5e-4}) {
    const Balance found = balance({.dt = dt, .damping = 0, .environment = empty_space(), .device = device()}, robot);
    EXPECT_GT(found.work, 0.1) << dt;
    EXPECT_NEAR(found.work, found.gained, second_order(dt) * found.largest) << dt;
  }
}

// In ocean-simple a mass loses the power drag v^2, and damping takes damping v^2: together 2 (drag + damping) times the
// kinetic energy. Both are integrated by steps of first order.
TEST_P(MusclePower, DragAndDampingTakeTheRestOfTheWork) {
  const Robot robot = bodies::random_voxels({.x = 3, .y = 2, .z = 2}, 1);
  constexpr double dt = 1e-3;
  for (const double damping : {0.0, 0.5})
    for (const float drag : {0.0f, 1.0f}) {
      if (damping == 0 && drag == 0) continue;
      const Balance found = balance(
          {.dt = dt, .damping = damping, .environment = OceanSimple{.point_drag = drag}, .device = device()}, robot);
      const double rate = double{drag} + damping, taken = rate * found.moved;
      EXPECT_GT(taken, 0.1) << damping << ", " << drag;
      EXPECT_NEAR(found.work, found.gained + taken, second_order(dt) * found.largest + rate * dt * taken)
          << damping << ", " << drag;
    }
}

TEST_P(MusclePower, WaterTakesWorkFromABody) {
  const Robot robot = bodies::random_voxels({.x = 3, .y = 2, .z = 2}, 1);
  const Balance found = balance({.damping = 0, .environment = Ocean{}, .device = device()}, robot);
  EXPECT_GT(found.work, found.gained + 10 * second_order(1e-3) * found.largest);
}

TEST_P(MusclePower, PassiveSpringsDeliverNone) {
  const Robot robot = bodies::voxels({.x = 2, .y = 1, .z = 1}, {.stiffness = 50});
  Simulation simulation({.device = device()}, {&robot, 1});
  const State start = bodies::shaken(robot, 0.02f, 0.5f, 1);
  simulation.set_state(0, start.positions, start.velocities);
  for (const Telemetry& sample : simulation.step_and_sample(50, 1)) EXPECT_EQ(sample.muscle_power, 0);
}

}  // namespace
}  // namespace mercury
