// SPDX-License-Identifier: Apache-2.0
// What neurons do with their sums, and noise. Only operations that are rounded alike on every machine are used, in
// double precision, so that every backend has the same bits: tanh and sigmoid are within 0.5001 units in the last
// place, so nearly always the nearest float.
#pragma once

#include <cmath>
#include <cstdint>

#include "mercury/brain.h"
#include "mercury/host_device.h"
#include "sim/physics/muscle.h"

namespace mercury {

// e^x for |x| <= 700, with a relative error below 1e-15:
//
//   x = n ln 2 + r, |r| <= ln 2 / 2        e^x = 2^n (1 + r + r^2/2! + ... + r^13/13!)
MERCURY_HOST_DEVICE double exponential(double x) {
  const double n = std::floor(x * 1.4426950408889634 + 0.5);
  const double r = (x - n * 0.693147180369123816490) - n * 1.90821492927058770002e-10;  // ln 2 in two parts
  constexpr double inverse_factorials[] = {
      1.0 / 6227020800, 1.0 / 479001600, 1.0 / 39916800, 1.0 / 3628800, 1.0 / 362880, 1.0 / 40320, 1.0 / 5040,
      1.0 / 720,        1.0 / 120,       1.0 / 24,       1.0 / 6,       1.0 / 2,      1.0,         1.0};
  double sum = 0;
  for (const double inverse : inverse_factorials) sum = sum * r + inverse;
  return sum * double_of(static_cast<std::uint64_t>(static_cast<std::int64_t>(n) + 1023) << 52);
}

MERCURY_HOST_DEVICE double within(double x, double bound) { return x > bound ? bound : x < -bound ? -bound : x; }

MERCURY_HOST_DEVICE float tanh_of(float sum) {
  const double x = within(static_cast<double>(sum), 20);
  if (std::fabs(x) < 1e-3) return static_cast<float>(x * (1 - x * x * (1.0 / 3)));
  const double e = exponential(2 * x);
  return static_cast<float>((e - 1) / (e + 1));
}

MERCURY_HOST_DEVICE float sigmoid_of(float sum) {
  return static_cast<float>(1 / (1 + exponential(-within(static_cast<double>(sum), 100))));
}

MERCURY_HOST_DEVICE float sine_of(float sum) {
  return sine_of_phase(phase_of_turns(static_cast<double>(sum) * 0.15915494309189533577));
}

MERCURY_HOST_DEVICE float activation_of(Activation activation, float sum) {
  switch (activation) {
    case Activation::tanh:
      return tanh_of(sum);
    case Activation::sigmoid:
      return sigmoid_of(sum);
    case Activation::relu:
      return sum > 0 ? sum : 0.0f;
    case Activation::sine:
      return sine_of(sum);
    default:
      return sum;
  }
}

// What an output neuron drives its actuator by.
MERCURY_HOST_DEVICE float drive_of(float y) { return std::isfinite(y) ? std::fmin(std::fmax(y, -1.0f), 1.0f) : 0.0f; }

// ln x for x in (0, 1]: x = 2^e m with m from 1/sqrt 2 to sqrt 2, and ln m = 2 artanh s, s = (m - 1) / (m + 1).
MERCURY_HOST_DEVICE double logarithm(double x) {
  const std::uint64_t bits = bits_of(x);
  double exponent = static_cast<double>(static_cast<std::int64_t>(bits >> 52) - 1023);
  double m = double_of((bits & 0xfffffffffffffu) | 0x3ff0000000000000u);
  if (m > 1.4142135623730951) m *= 0.5, exponent += 1;
  const double s = (m - 1) / (m + 1);
  double sum = 0;
  for (int k = 19; k > 0; k -= 2) sum = sum * s * s + 1.0 / k;
  return exponent * 0.69314718055994530942 + 2 * s * sum;
}

// 64 random bits by number (Steele, Lea and Flood, OOPSLA 2014: the output of SplitMix64).
MERCURY_HOST_DEVICE std::uint64_t random_bits(std::uint64_t number) {
  number = (number ^ (number >> 30)) * 0xbf58476d1ce4e5b9u;
  number = (number ^ (number >> 27)) * 0x94d049bb133111ebu;
  return number ^ (number >> 31);
}

// A normal number for a seed and a place in its stream (Box and Muller 1958).
MERCURY_HOST_DEVICE float normal_number(std::uint64_t seed, std::uint64_t time, std::uint64_t place) {
  const std::uint64_t step = 0x9e3779b97f4a7c15u;  // of SplitMix64
  const std::uint64_t first =
      random_bits(random_bits(random_bits(seed + step) + (time + 1) * step) + (place + 1) * step);
  const double uniform = (static_cast<double>(first >> 11) + 1) * 0x1p-53;  // in (0, 1]
  return static_cast<float>(std::sqrt(-2 * logarithm(uniform))) * sine_of_phase(random_bits(first + step));
}

}  // namespace mercury
