// SPDX-License-Identifier: Apache-2.0
// Random numbers that are the same on every machine, compiler and standard library.
#pragma once

#include <cstdint>

namespace mercury {

// The seed of the index-th of many things drawn from one seed. It depends on both alone, so a thing stays the same
// however many others are drawn with it.
std::uint64_t seed_of(std::uint64_t seed, std::uint64_t index);

// Natural logarithm of x > 0, finite and normal, from the four operations alone. These are rounded alike on every
// machine; std::log is not. The error is at most 4 units in the last place.
double portable_log(double x);

// A stream of random numbers: SplitMix64 (Steele, Lea and Flood, OOPSLA 2014). The same seed gives the same numbers,
// bit for bit, on every machine; the distributions of <random> do not promise that.
class Random {
 public:
  explicit Random(std::uint64_t seed) : state_(seed) {}

  std::uint64_t bits();                     // 64 random bits
  double uniform();                         // in [0, 1), a multiple of 2^-53
  double uniform(double low, double high);  // in [low, high]
  std::uint64_t below(std::uint64_t n);     // 0 .. n-1 with equal probability; n > 0
  bool chance(double probability);          // true with that probability
  double normal();                          // mean 0, standard deviation 1 (Marsaglia's polar method)

 private:
  std::uint64_t state_;
  double spare_ = 0;
  bool has_spare_ = false;
};

}  // namespace mercury
