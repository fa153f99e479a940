// SPDX-License-Identifier: Apache-2.0
// The functions that thoughts consist of, against what they stand for: activations, noise, and the frame of a body.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "bodies.h"
#include "sim/physics/activation.h"
#include "sim/physics/body_frame.h"

namespace mercury {
namespace {

// Units in the last place between a float and the true value.
double error_in_ulps(float got, double expected) {
  const float nearest = static_cast<float>(expected);
  const double ulp =
      static_cast<double>(std::nextafter(std::abs(nearest), INFINITY)) - static_cast<double>(std::abs(nearest));
  return std::abs(static_cast<double>(got) - expected) / ulp;
}

TEST(Activations, AreWithinARoundingOfTheTrueFunctions) {
  double worst_tanh = 0, worst_sigmoid = 0;
  for (int i = -200000; i <= 200000; ++i) {
    const float x =
        std::copysign(std::pow(std::abs(static_cast<float>(i)) / 200000.0f, 3.0f) * 30, static_cast<float>(i));
    const auto exact = static_cast<double>(x);
    worst_tanh = std::max(worst_tanh, error_in_ulps(tanh_of(x), std::tanh(exact)));
    worst_sigmoid = std::max(worst_sigmoid, error_in_ulps(sigmoid_of(x), 1 / (1 + std::exp(-exact))));
  }
  EXPECT_LE(worst_tanh, 0.5001);
  EXPECT_LE(worst_sigmoid, 0.5001);
  EXPECT_EQ(activation_of(Activation::relu, -2), 0);
  EXPECT_EQ(activation_of(Activation::linear, -2), -2);
  EXPECT_NEAR(activation_of(Activation::sine, 1.25f), std::sin(1.25), 1e-6);
}

TEST(Activations, ExponentialAndLogarithmAreExactToFourteenDigits) {
  for (double x = -600; x < 600; x += 0.37) EXPECT_NEAR(exponential(x) / std::exp(x), 1, 1e-14) << x;
  for (double x = 1; x > 1e-300; x *= 0.83) EXPECT_NEAR(logarithm(x), std::log(x), 1e-14 * (1 + std::abs(std::log(x))));
}

TEST(Activations, NoiseIsNormal) {
  constexpr int count = 200000;
  double sum = 0, squares = 0, fourth = 0, products = 0;
  float previous = 0;
  int beyond_two = 0;
  for (int i = 0; i < count; ++i) {
    const float x = normal_number(3, static_cast<std::uint64_t>(i) / 10, static_cast<std::uint64_t>(i) % 10);
    const auto y = static_cast<double>(x);
    sum += y;
    squares += y * y;
    fourth += y * y * y * y;
    products += y * static_cast<double>(previous);
    beyond_two += std::abs(y) > 2;
    previous = x;
  }
  // Within five standard deviations of what theory says.
  const double n = count;
  EXPECT_NEAR(sum / n, 0, 5 / std::sqrt(n));
  EXPECT_NEAR(squares / n, 1, 5 * std::sqrt(2 / n));
  EXPECT_NEAR(fourth / n, 3, 5 * std::sqrt(96 / n));
  EXPECT_NEAR(products / n, 0, 5 / std::sqrt(n));
  const double share = std::erfc(std::numbers::sqrt2);
  EXPECT_NEAR(beyond_two / n, share, 5 * std::sqrt(share / n));
}

TEST(BodyFrame, IsTheRotationOfATurnedBody) {
  for (std::uint64_t seed = 0; seed < 50; ++seed) {
    const std::array<Vec3, 3> rows = bodies::random_rotation(seed);
    double s[9] = {};
    for (int i = 0; i < (seed % 2 == 0 ? 8 : 4); ++i) {  // a cube, or a flat square
      const double x[] = {(i & 1) - 0.5, 1.5 * ((i >> 1 & 1) - 0.5), seed % 2 == 0 ? 0.7 * ((i >> 2) - 0.5) : 0.0};
      for (std::size_t a = 0; a < 3; ++a)
        for (std::size_t b = 0; b < 3; ++b)
          s[3 * a + b] += x[a] * (static_cast<double>(rows[b].x) * x[0] + static_cast<double>(rows[b].y) * x[1] +
                                  static_cast<double>(rows[b].z) * x[2]);
    }
    const Rotation rotation = rotation_of(s);
    for (std::size_t a = 0; a < 3; ++a) {
      EXPECT_NEAR(rotation.r[3 * a], rows[a].x, 1e-6);
      EXPECT_NEAR(rotation.r[3 * a + 1], rows[a].y, 1e-6);
      EXPECT_NEAR(rotation.r[3 * a + 2], rows[a].z, 1e-6);
    }
  }
}

}  // namespace
}  // namespace mercury
