// SPDX-License-Identifier: Apache-2.0
#include "robots/importers/substances.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <numbers>

#include "mercury/random.h"

namespace mercury {
namespace {

using std::numbers::pi;

Substance muscle(double amplitude, double phase, bool half_wave = false) {
  return {.stiffness = 50, .amplitude = amplitude, .frequency = 3, .phase = phase, .half_wave = half_wave};
}

// At every moment the rest length is the mean of the two.
TEST(MeanSubstance, IsTheMeanAtAllTimes) {
  const Substance a = muscle(0.2, 0.3), b = muscle(-0.1, 2.5), mean = mean_substance(std::array{a, b});
  const auto length = [](const Substance& substance, double t) {
    return substance.amplitude * std::sin(substance.frequency * t + substance.phase);
  };
  for (double t = 0; t < 3; t += 0.1) EXPECT_NEAR(length(mean, t), (length(a, t) + length(b, t)) / 2, 1e-12);
}

TEST(MeanSubstance, OfOppositeMusclesDoesNotMove) {
  const Substance mean = mean_substance(std::array{muscle(0.2, 1), muscle(-0.2, 1)});
  EXPECT_EQ(mean.amplitude, 0);
  EXPECT_EQ(mean.frequency, 0);
}

TEST(MeanSubstance, OfAPassiveVoxelLowersTheAmplitudeAlone) {
  const Substance mean = mean_substance(std::array{muscle(0.2, 1), Substance{.stiffness = 100}});
  EXPECT_DOUBLE_EQ(mean.amplitude, 0.1);
  EXPECT_DOUBLE_EQ(mean.frequency, 3);
  EXPECT_DOUBLE_EQ(mean.stiffness, 75);
}

// A half wave acts where the sine is negative: a negative amplitude is not a positive one half a turn later.
TEST(MeanSubstance, KeepsTheSignOfHalfWaves) {
  const Substance mean = mean_substance(std::array{muscle(-0.2, 1, true), muscle(-0.1, 1, true)});
  EXPECT_TRUE(mean.half_wave);
  EXPECT_NEAR(mean.amplitude, -0.15, 1e-12);
  EXPECT_NEAR(mean.phase, 1, 1e-12);
}

TEST(SubstanceRounding, KeepsLawsThatFit) {
  std::vector<Substance> substances;
  for (int i = 0; i < 255; ++i) substances.push_back(muscle(0.1, i * 0.01));
  substances.push_back(substances.front());
  const SubstanceGroups groups = grouped(substances, 255);
  EXPECT_TRUE(groups.rounding.is_exact());
  EXPECT_EQ(groups.substances.size(), 255u);
  EXPECT_EQ(groups.group_of.front(), groups.group_of.back());
  for (std::size_t i = 0; i < substances.size(); ++i) EXPECT_EQ(groups.substances[groups.group_of[i]], substances[i]);
}

TEST(SubstanceRounding, RoundsToStepsThatFitAndSaysByHowMuch) {
  std::vector<Substance> substances;
  for (int i = 0; i < 1000; ++i) substances.push_back(muscle(0.1, 2 * pi * i / 1000));
  const SubstanceGroups groups = grouped(substances, 255);
  EXPECT_LE(groups.substances.size(), 255u);
  EXPECT_GT(groups.substances.size(), 200u);  // nearly as fine as can be
  EXPECT_EQ(groups.rounding.substances, 1000u);
  double largest = 0;
  for (std::size_t i = 0; i < substances.size(); ++i)
    largest = std::max(
        largest, std::abs(std::remainder(groups.substances[groups.group_of[i]].phase - substances[i].phase, 2 * pi)));
  EXPECT_NEAR(groups.rounding.phase, largest, 1e-12);
  EXPECT_LT(largest, pi / 200);
  EXPECT_LT(groups.rounding.stiffness, 1e-12);
}

// Points that fill a disk are rounded best to a hexagonal lattice: the mean square of the error is 5 / (18 sqrt 3)
// times the area per group (Fejes Toth 1953).
TEST(SubstanceRounding, RoundsMovementsNearlyAsWellAsAnythingCan) {
  constexpr std::size_t groups = 255;
  constexpr double largest = 0.2;
  Random random(3);
  std::vector<Substance> substances;
  for (int i = 0; i < 20000; ++i) {
    const double amplitude = largest * std::sqrt(random.uniform());
    substances.push_back(muscle(amplitude, 2 * pi * random.uniform()));
  }
  const SubstanceGroups found = grouped(substances, groups);
  EXPECT_LE(found.substances.size(), groups);
  double squares = 0;
  for (std::size_t i = 0; i < substances.size(); ++i)
    squares += std::norm(movement_of(found.substances[found.group_of[i]]) - movement_of(substances[i]));
  const double best = 5 / (18 * std::sqrt(3.0)) * pi * largest * largest / groups;
  const double mean = squares / static_cast<double>(substances.size());
  EXPECT_LT(mean, 1.15 * best);
  EXPECT_GT(mean, 0.85 * best);
}

// A stiffness counts at strains as large as the movements: 255 groups serve what varies.
TEST(SubstanceRounding, GivesEachValueTheGroupsThatItNeeds) {
  std::vector<Substance> substances;
  for (int i = 0; i < 4000; ++i) {
    Substance substance = muscle(0.1, 0.5);
    substance.stiffness = std::exp(i / 4000.0);
    substance.relaxation_time = 0.01 * (i % 2);
    substances.push_back(substance);
  }
  const SubstanceGroups found = grouped(substances, 254);
  for (std::size_t i = 0; i < substances.size(); ++i)
    EXPECT_DOUBLE_EQ(found.substances[found.group_of[i]].relaxation_time, substances[i].relaxation_time);
  EXPECT_LT(found.rounding.stiffness, 1.0 / 127);  // half of what 127 groups of one size would have is the least
  EXPECT_LT(found.rounding.phase, 1e-9);
}

TEST(SubstanceRounding, NeverMixesMusclesWithPassiveVoxels) {
  std::vector<Substance> substances;
  for (int i = 0; i < 500; ++i) {
    substances.push_back(muscle(0.001 * (i + 1), i));
    substances.push_back({.stiffness = 10.0 + i});
  }
  const SubstanceGroups groups = grouped(substances, 8);
  EXPECT_LE(groups.substances.size(), 8u);
  for (std::size_t i = 0; i < substances.size(); i += 2) EXPECT_NE(groups.group_of[i], groups.group_of[i + 1]);
}

}  // namespace
}  // namespace mercury
