// SPDX-License-Identifier: Apache-2.0
#include "mercury/random.h"

#include <cmath>

namespace mercury {
namespace {

std::uint64_t mix(std::uint64_t z) {
  z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
  z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
  return z ^ (z >> 31);
}

constexpr std::uint64_t golden_gamma = 0x9e3779b97f4a7c15u;

}  // namespace

std::uint64_t seed_of(std::uint64_t seed, std::uint64_t index) {
  return mix(mix(seed + golden_gamma) + (index + 1) * golden_gamma);
}

double portable_log(double x) {
  int exponent = 0;
  double m = std::frexp(x, &exponent);  // [0.5, 1), exact
  if (m < 0.70710678118654752) {
    m *= 2;
    --exponent;
  }
  // ln m = 2 artanh z; |z| < 0.172, so the terms fall by 34 each and the last one is below 2^-53 of the first.
  const double z = (m - 1) / (m + 1);
  const double z2 = z * z;
  double series = 0;
  for (int n = 23; n >= 1; n -= 2) series = series * z2 + 1.0 / n;
  return exponent * 0.69314718055994531 + 2 * z * series;
}

std::uint64_t Random::bits() { return mix(state_ += golden_gamma); }

double Random::uniform() { return static_cast<double>(bits() >> 11) * 0x1p-53; }

double Random::uniform(double low, double high) { return low + (high - low) * uniform(); }

std::uint64_t Random::below(std::uint64_t n) {
  const std::uint64_t unfair = (0 - n) % n;  // 2^64 mod n numbers would make some results more likely
  std::uint64_t r = bits();
  while (r < unfair) r = bits();
  return r % n;
}

bool Random::chance(double probability) { return uniform() < probability; }

double Random::normal() {
  if (has_spare_) {
    has_spare_ = false;
    return spare_;
  }
  double u = 0, v = 0, s = 0;
  do {
    u = 2 * uniform() - 1;
    v = 2 * uniform() - 1;
    s = u * u + v * v;
  } while (s >= 1 || s == 0);
  const double factor = std::sqrt(-2 * portable_log(s) / s);
  spare_ = v * factor;
  has_spare_ = true;
  return u * factor;
}

}  // namespace mercury
