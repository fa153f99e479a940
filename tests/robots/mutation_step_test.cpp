// SPDX-License-Identifier: Apache-2.0
// Steps of mutations against their distributions.
#include "robots/mutation_step.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "mercury/cppn.h"
#include "mercury/muscle_laws.h"
#include "mercury/shell.h"

namespace mercury {
namespace {

constexpr int draws = 40'000;
constexpr double sigmas = 4;  // of every statistic below

// Of the absolute values of step_number().
double share_below(double limit, int tail) {
  Random random(static_cast<std::uint64_t>(tail) + 1);
  int below = 0;
  for (int i = 0; i < draws; ++i) below += std::abs(step_number(random, tail)) < limit;
  return static_cast<double>(below) / draws;
}
double deviation(double share) { return sigmas * std::sqrt(share * (1 - share) / draws); }

// The distribution functions of Student's t with 1 and 2 degrees of freedom have closed forms, that of normal numbers
// is erf.
TEST(StepNumbers, AreNormalOrStudents) {
  for (const double limit : {0.3, 1.0, 3.0, 10.0}) {
    const double normal = std::erf(limit / std::numbers::sqrt2), cauchy = 2 / std::numbers::pi * std::atan(limit);
    const double two = limit / std::sqrt(2 + limit * limit);
    EXPECT_NEAR(share_below(limit, 0), normal, deviation(normal) + 1e-12) << limit;
    EXPECT_NEAR(share_below(limit, 1), cauchy, deviation(cauchy)) << limit;
    EXPECT_NEAR(share_below(limit, 2), two, deviation(two)) << limit;
    EXPECT_NEAR(share_below(limit, 100), normal, deviation(normal) + 0.01) << limit;
  }
  Random random(1), same(1);
  EXPECT_EQ(step_number(random, 0), same.normal());
  for (int i = 0; i < draws; ++i) EXPECT_LE(std::abs(step_number(random, 1)), 1e6);
}

// The logarithm moves by normal numbers of the standard deviation 1 / sqrt(2 n).
TEST(AdaptedSteps, AreLogNormal) {
  constexpr double step = 0.7;
  for (const std::size_t numbers : {1u, 8u, 60u}) {
    const double tau = 1 / std::sqrt(2.0 * static_cast<double>(numbers));
    Random random(numbers);
    double sum = 0, squares = 0;
    for (int i = 0; i < draws; ++i) {
      const double log = std::log(adapted_step(step, numbers, {1e-9, 1e9}, random) / step);
      sum += log;
      squares += log * log;
    }
    EXPECT_NEAR(sum / draws, 0, sigmas * tau / std::sqrt(draws));
    EXPECT_NEAR(std::sqrt(squares / draws), tau, sigmas * tau / std::sqrt(2 * draws));
  }
}

TEST(AdaptedSteps, StayWithinTheirRange) {
  Random random(1);
  constexpr StepRange range{0.5, 2};
  double lowest = 1, highest = 1, step = 1;
  for (int i = 0; i < 2000; ++i) {
    step = adapted_step(step, 1, range, random);
    lowest = std::min(lowest, step);
    highest = std::max(highest, step);
  }
  EXPECT_EQ(lowest, 0.5);
  EXPECT_EQ(highest, 2);
  EXPECT_DOUBLE_EQ(crossed_step(0.5, 2, range), 1);
  EXPECT_DOUBLE_EQ(crossed_step(2, 2, range), 2);
  EXPECT_DOUBLE_EQ(crossed_step(8, 8, range), 2);
}

// Mirrors at either end: walks back and forth.
TEST(ReflectedValues, AreWithinTheRange) {
  EXPECT_DOUBLE_EQ(reflected(0.3, 0, 1), 0.3);
  EXPECT_DOUBLE_EQ(reflected(-0.3, 0, 1), 0.3);
  EXPECT_DOUBLE_EQ(reflected(1.3, 0, 1), 0.7);
  EXPECT_DOUBLE_EQ(reflected(2.3, 0, 1), 0.3);
  EXPECT_DOUBLE_EQ(reflected(-5, -1, 3), 3);
  EXPECT_DOUBLE_EQ(reflected(-6, -1, 3), 2);
  for (const double far : {1e6, -1e9, 1e300, -1e300}) {
    EXPECT_GE(reflected(far, -1, 3), -1);
    EXPECT_LE(reflected(far, -1, 3), 3);
  }
}

// One muscle in the middle of wide ranges: its moves of a small strength are those of the distribution.
TEST(MuscleMutation, HasTheTailsOfItsDistribution) {
  const std::vector<Material> muscle{{50, 0.001f, 10, 1}};
  constexpr double strength = 0.01, unit = strength * 0.5;  // [rad/s]
  for (const int tail : {0, 1}) {
    int moved = 0, far = 0;
    for (std::uint64_t seed = 0; seed < 20'000; ++seed) {
      const Material child = mutate_muscle_laws(muscle, strength, seed, {}, tail)[0];
      const double move = (static_cast<double>(child.frequency) - 10) / unit;
      moved += move != 0;
      far += std::abs(move) > 4;
    }
    const double share = static_cast<double>(far) / moved;
    const double expected = tail == 0 ? std::erfc(4 / std::numbers::sqrt2) : 1 - 2 / std::numbers::pi * std::atan(4.0);
    // A second move of the same frequency, one time in 40, adds to it.
    EXPECT_NEAR(share, expected, 0.02) << tail;
  }
}

TEST(MuscleMutation, KeepsItsRangesWithHeavyTails) {
  const std::vector<Material> muscle{{50, 0.14f, 2, 1}, {50, -0.3f, 19, 6}};
  for (const double strength : {0.1, 10.0, 1e6})
    for (std::uint64_t seed = 0; seed < 300; ++seed)
      for (const Material& child : mutate_muscle_laws(muscle, strength, seed, {}, 1)) {
        ASSERT_LE(std::abs(child.amplitude), 0.4f);
        ASSERT_GE(child.frequency, 0);
        ASSERT_LE(child.frequency, 20);
        ASSERT_GE(child.phase, 0);
        ASSERT_LT(child.phase, 2 * std::numbers::pi);
      }
  const ShellGenome shell = random_shell_genome({}, 3);
  const CppnGenome painted = random_cppn_genome({}, 3);
  for (std::uint64_t seed = 0; seed < 300; ++seed) {
    EXPECT_NO_THROW(validate(mutate_muscles(shell, 5, seed, 1)));
    EXPECT_NO_THROW(validate(mutate_muscles(painted, 5, seed, 1)));
  }
}

}  // namespace
}  // namespace mercury
