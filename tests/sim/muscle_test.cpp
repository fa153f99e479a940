// SPDX-License-Identifier: Apache-2.0
// The muscle law L(t) = L0 (1 + dL0 sin(omega t + phi)), its half waves, and its phase on long runs.
#include "sim/physics/muscle.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>

#include "backend.h"
#include "bodies.h"

namespace mercury {
namespace {

long double exact_factor(const Material& material, long double time) {
  const long double omega = material.frequency, phi = material.phase, amplitude = material.amplitude;
  const long double sine = std::sin(omega * time + phi);
  return 1 + amplitude * (material.half_wave ? std::min(0.0L, sine) : sine);
}

std::vector<Material> many_muscles() {
  std::vector<Material> muscles;
  for (const Material& material : default_materials())
    if (material.amplitude != 0) muscles.push_back(material);
  std::mt19937_64 random(1);
  const auto uniform = [&](float low, float high) {
    return low + (high - low) * 0x1p-24f * static_cast<float>(random() >> 40);
  };
  for (int i = 0; i < 300; ++i)
    muscles.push_back({uniform(1, 1000), uniform(-0.99f, 0.99f), uniform(-50, 50), uniform(-100, 100)});
  for (std::size_t i = 0, whole = muscles.size(); i < whole; ++i) {
    muscles.push_back(muscles[i]);
    muscles.back().half_wave = true;
  }
  return muscles;
}

TEST(Muscle, FactorIsExactToFloatRoundingInTheFirstMinutes) {
  for (const Material& muscle : many_muscles())
    for (const double dt : {1e-3, 1.0 / 3000, 0.02})
      for (std::int64_t step = 0; step < 10000; step += 37) {
        const auto exact = exact_factor(muscle, static_cast<long double>(dt) * static_cast<long double>(step));
        ASSERT_NEAR(muscle_factor(muscle, dt, step), static_cast<double>(exact), 3e-7)
            << "omega " << muscle.frequency << " phi " << muscle.phase << " step " << step << " dt " << dt;
      }
}

// per_step is rounded to 2^-54 turn, 3.5e-16 rad, so the phase may be off by as much per step.
TEST(Muscle, PhaseErrorStaysFarBelowATenThousandthOfARadianAtAMillionSecondsAndBeyond) {
  for (const Material& muscle : many_muscles())
    for (const double dt : {1e-3, 7.3e-4, 1.0 / 300})
      for (const double seconds : {1e5, 1e6, 1e7})
        for (int offset = 0; offset < 20; ++offset) {
          const std::int64_t step = std::llround(seconds / dt) + 977 * offset;
          const auto exact = exact_factor(muscle, static_cast<long double>(dt) * static_cast<long double>(step));
          ASSERT_NEAR(muscle_factor(muscle, dt, step), static_cast<double>(exact),
                      5e-7 + 4e-16 * static_cast<double>(step))
              << "omega " << muscle.frequency << " phi " << muscle.phase << " step " << step << " dt " << dt;
        }
}

TEST(Muscle, AHalfWaveIsTheWholeWaveInOneHalfAndRestInTheOther) {
  Material whole{50, 0.3f, 2, 0}, half = whole;
  half.half_wave = true;
  constexpr double period = 2 * std::numbers::pi / 2;  // [s]
  constexpr std::int64_t steps = 1000;
  float shortest = 1;
  for (std::int64_t step = 1; step < steps; ++step) {
    const float factor = muscle_factor(half, period / steps, step);
    if (step < steps / 2) {
      EXPECT_EQ(factor, 1) << step;
    } else {
      EXPECT_EQ(factor, muscle_factor(whole, period / steps, step)) << step;
    }
    shortest = std::min(shortest, factor);
  }
  EXPECT_FLOAT_EQ(shortest, 1 - 0.3f);
  // A negative amplitude makes it longer, never shorter.
  half.amplitude = -0.3f;
  EXPECT_FLOAT_EQ(muscle_factor(half, period / 4, 3), 1.3f);
  EXPECT_EQ(muscle_factor(half, period / 4, 1), 1);
}

// The central difference is off by at most (omega h)^2 / 6 of the largest rate, 2e-5 here, and by the rounding of two
// factors, which are within 3e-7. Where the wave begins or ends in between, it is not the rate.
TEST(Muscle, TheRateOfAHalfWaveIsItsDerivative) {
  const Material muscle{50, 0.3f, 2, 0.4f, true};
  constexpr double h = 1e-3;  // [s]
  int moving = 0, resting = 0;
  for (std::int64_t step = 1; step < 4000; ++step) {
    const double before = std::sin(2 * h * static_cast<double>(step - 1) + double{0.4f}),
                 after = std::sin(2 * h * static_cast<double>(step + 1) + double{0.4f});
    if (before * after <= 0) continue;
    const Clock clock{.dt = h, .step = step};
    const double rate = muscle_rate(muscle, phase_at(muscle_phase(muscle, clock), step));
    const double difference =
        (double{muscle_factor(muscle, h, step + 1)} - double{muscle_factor(muscle, h, step - 1)}) / (2 * h);
    ASSERT_NEAR(rate, difference, 2e-5 + 3e-7 / h) << step;
    (after < 0 ? moving : resting) += 1;
    ASSERT_TRUE(after < 0 || rate == 0) << step;
  }
  EXPECT_GT(moving, 1000);
  EXPECT_GT(resting, 1000);
}

TEST(Muscle, APassiveMaterialNeverMoves) {
  for (std::int64_t step = 0; step < 1000; ++step) EXPECT_EQ(muscle_factor(Material{40, 0, 3, 1}, 1e-3, step), 1.0f);
}

// At a time step of many minutes, an XPBD spring has its rest length after every step, and damping leaves no velocity.
// So positions show the muscle law over any time. Corrections are then summed in units of 2^-18 of the spring's length,
// which gives the tolerance. It corresponds to 1e-5 rad.
class MuscleLength : public BackendTest {
 protected:
  static constexpr double dt = 997.3;  // [s]
  Configuration configuration() const {
    return {.dt = dt, .damping = 1, .solver = Solver::xpbd, .environment = empty_space(), .device = device()};
  }
  static double length_of(const Simulation& simulation, std::size_t robot) {
    const auto x = simulation.positions(robot);
    return length(x[1] - x[0]);
  }
};
INSTANTIATE_TEST_SUITE_P(All, MuscleLength, every_device, BackendTest::name);

TEST_P(MuscleLength, OfEveryDefaultMuscleIsExactForAMillionSeconds) {
  std::vector<Robot> robots;
  std::vector<Material> muscles;
  for (const Material& material : default_materials()) {
    if (material.amplitude == 0) continue;
    muscles.push_back(material);
    muscles.back().amplitude = 0.9f;  // so that a small error of the phase shows
    robots.push_back(bodies::pair(muscles.back()));
    muscles.push_back(muscles.back());
    muscles.back().half_wave = true;
    robots.push_back(bodies::pair(muscles.back()));
  }
  Simulation simulation(configuration(), robots);
  while (simulation.time() < 1e6) {
    const double time = simulation.time();  // a step from time to time + dt uses L(time)
    simulation.step();
    if (simulation.steps() % 100 != 1 && simulation.time() < 1e6) continue;
    for (std::size_t i = 0; i < robots.size(); ++i)
      ASSERT_NEAR(length_of(simulation, i), static_cast<double>(exact_factor(muscles[i], time)), 8e-6)
          << "omega " << muscles[i].frequency << " at " << time << " s";
  }
}

TEST_P(MuscleLength, KeepsItsPhaseWhenTheTimeStepOrTheMaterialChanges) {
  Material muscle{50, 0.9f, 3.7f, 0.5f};
  const Robot robot = bodies::pair(muscle);
  Simulation simulation(configuration(), {&robot, 1});
  simulation.step(300);
  Configuration changed = configuration();
  changed.dt = 1234.5;
  simulation.configure(changed);
  simulation.step(200);
  long double time = 300 * 997.3L + 200 * 1234.5L;
  EXPECT_NEAR(simulation.time(), static_cast<double>(time), 1e-6);
  simulation.step();
  EXPECT_NEAR(length_of(simulation, 0), static_cast<double>(exact_factor(muscle, time)), 8e-6);
  muscle = {20, -0.5f, 1.9f, 2, true};
  simulation.set_material(0, 1, muscle);
  simulation.step();
  time += 1234.5L;
  EXPECT_NEAR(length_of(simulation, 0), static_cast<double>(exact_factor(muscle, time)), 8e-6);
}

}  // namespace
}  // namespace mercury
