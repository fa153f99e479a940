// SPDX-License-Identifier: Apache-2.0
#include "robots/mutation_step.h"

#include <algorithm>
#include <cmath>

#include "robots/portable_math.h"

namespace mercury {

double adapted_step(double step, std::size_t numbers, StepRange range, Random& random) {
  const double tau = 1 / std::sqrt(2 * static_cast<double>(std::max<std::size_t>(1, numbers)));
  return std::clamp(step * portable_exp(tau * random.normal()), range.smallest, range.largest);
}

double crossed_step(double a, double b, StepRange range) {
  return std::clamp(std::sqrt(a * b), range.smallest, range.largest);
}

double step_number(Random& random, int tail) {
  constexpr double farthest = 1e6;
  const double normal = random.normal();
  if (tail == 0) return normal;
  double squares = 0;
  for (int i = 0; i < tail; ++i) {
    const double other = random.normal();
    squares += other * other;
  }
  if (squares == 0) return normal;
  return std::clamp(normal / std::sqrt(squares / tail), -farthest, farthest);
}

double reflected(double value, double low, double high) {
  const double length = high - low;
  const double at = std::abs(std::fmod(value - low, 2 * length));
  return std::clamp(low + (at > length ? 2 * length - at : at), low, high);
}

}  // namespace mercury
