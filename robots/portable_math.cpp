// SPDX-License-Identifier: Apache-2.0
#include "robots/portable_math.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace mercury {

// Reduces the angle to an eighth of a turn, then sums the Taylor series.
SineCosine wave(double turns) {
  const double quarters = std::round(4 * turns);
  const double x = 2 * std::numbers::pi * (turns - quarters / 4), square = x * x;
  double sine = 1, cosine = 1;
  for (int k = 16; k > 0; k -= 2) {
    sine = 1 - square / (k * (k + 1)) * sine;
    cosine = 1 - square / (k * (k - 1)) * cosine;
  }
  sine *= x;
  switch (static_cast<int>(quarters - 4 * std::floor(quarters / 4))) {
    case 0:
      return {sine, cosine};
    case 1:
      return {cosine, -sine};
    case 2:
      return {-sine, -cosine};
    default:
      return {-cosine, sine};
  }
}

// Within half a right angle of an axis, atan(t) = 2 atan(t / (1 + sqrt(1 + t^2))) twice leaves |t| < 0.2, where twelve
// terms of the series leave less than 1e-18.
double turns_of(const SineCosine& point) {
  const double x = std::abs(point.cosine), y = std::abs(point.sine);
  if (x == 0 && y == 0) return 0;
  double t = std::min(x, y) / std::max(x, y);
  for (int i = 0; i < 2; ++i) t /= 1 + std::sqrt(1 + t * t);
  double series = 0;
  for (int k = 23; k > 0; k -= 2) series = 1. / k - t * t * series;
  double turns = 4 * t * series / (2 * std::numbers::pi);
  if (y > x) turns = 0.25 - turns;
  if (point.cosine < 0) turns = 0.5 - turns;
  if (point.sine < 0) turns = 1 - turns;
  return turns < 1 ? turns : 0;
}

// e^x = 2^n e^r with |r| <= ln(2) / 2, where 14 terms of the Taylor series leave less than 2^-57.
double portable_exp(double x) {
  if (x < -700) return 0;
  const double n = std::round(x * 1.4426950408889634);
  // ln 2 in two parts; the first has 32 bits, so its products with n are exact.
  const double r = (x - n * 0x1.62e42fee00000p-1) - n * 0x1.a39ef35793c76p-33;
  double series = 1;
  for (int k = 13; k >= 1; --k) series = 1 + r / k * series;
  return std::ldexp(series, static_cast<int>(n));
}

}  // namespace mercury
