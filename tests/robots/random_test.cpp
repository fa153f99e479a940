// SPDX-License-Identifier: Apache-2.0
#include "mercury/random.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <set>

namespace mercury {
namespace {

TEST(Random, FollowsTheReferenceStreamOfSplitMix64) {
  // First outputs of the algorithm's published reference for seed 1234567.
  Random random(1234567);
  for (const std::uint64_t expected :
       {6457827717110365317u, 3203168211198807973u, 9817491932198370423u, 4593380528125082431u, 16408922859458223821u})
    EXPECT_EQ(random.bits(), expected);
}

TEST(Random, LogarithmAgreesWithTheLibrarysToFourUlp) {
  Random random(3);
  const auto check = [](double x) {
    const long double exact = std::log(static_cast<long double>(x));
    const double ulp =
        std::nextafter(std::abs(static_cast<double>(exact)), INFINITY) - std::abs(static_cast<double>(exact));
    EXPECT_LE(std::abs(static_cast<double>(static_cast<long double>(portable_log(x)) - exact)), 4 * ulp) << x;
  };
  for (int i = 0; i < 20000; ++i) check(random.uniform() + 0x1p-60);
  for (const double x :
       {1e-300, 1e-18, 0.5, 0.7071067811865475, 0.7071067811865476, 1 - 0x1p-53, 1 + 0x1p-52, 2., 1e300})
    check(x);
  EXPECT_EQ(portable_log(1), 0);
}

TEST(Random, NormalsHaveTheMomentsOfTheNormalDistribution) {
  Random random(7);
  constexpr int n = 200000;
  std::array<double, 5> moments{};
  int beyond_two = 0;
  for (int i = 0; i < n; ++i) {
    const double x = random.normal();
    for (std::size_t k = 1; k < moments.size(); ++k) moments[k] += std::pow(x, static_cast<double>(k)) / n;
    beyond_two += std::abs(x) > 2;
  }
  // Five standard errors each: sqrt(var(x^k) / n).
  EXPECT_NEAR(moments[1], 0, 5 * std::sqrt(1. / n));
  EXPECT_NEAR(moments[2], 1, 5 * std::sqrt(2. / n));
  EXPECT_NEAR(moments[3], 0, 5 * std::sqrt(15. / n));
  EXPECT_NEAR(moments[4], 3, 5 * std::sqrt(96. / n));
  EXPECT_NEAR(static_cast<double>(beyond_two) / n, std::erfc(std::sqrt(2.)), 5 * std::sqrt(0.0455 / n));
}

TEST(Random, BelowIsUniformAndStaysBelow) {
  Random random(11);
  std::array<int, 7> counts{};
  constexpr int n = 70000;
  for (int i = 0; i < n; ++i) {
    const auto r = random.below(counts.size());
    ASSERT_LT(r, counts.size());
    ++counts[r];
  }
  double chi_squared = 0;
  for (const int count : counts) chi_squared += std::pow(count - 10000., 2) / 10000;
  EXPECT_LT(chi_squared, 22.5);  // 6 degrees of freedom, exceeded once in 1,000
  EXPECT_EQ(Random(1).below(1), 0u);
}

TEST(Random, UniformStaysInItsInterval) {
  Random random(5);
  for (int i = 0; i < 10000; ++i) {
    const double u = random.uniform();
    EXPECT_TRUE(u >= 0 && u < 1);
    const double w = random.uniform(-3, 2);
    EXPECT_TRUE(w >= -3 && w <= 2);
  }
}

TEST(Random, SeedsOfDifferentThingsDiffer) {
  std::set<std::uint64_t> seeds;
  for (std::uint64_t seed = 0; seed < 50; ++seed)
    for (std::uint64_t index = 0; index < 200; ++index) seeds.insert(seed_of(seed, index));
  EXPECT_EQ(seeds.size(), 10000u);
}

}  // namespace
}  // namespace mercury
