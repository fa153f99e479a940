// SPDX-License-Identifier: Apache-2.0
#include "robots/mutation_step.h"

#include <algorithm>
#include <cmath>

namespace mercury {
namespace {

// The parabola at a bound spans from a margin outside to a margin inside.
double margin_of(double low, double high) { return (high - low) / 20; }

}  // namespace

double bounded(double number, double low, double high) {
  const double margin = margin_of(low, high), length = high - low + 2 * margin;
  double at = number - (low - margin);
  at -= 2 * length * std::floor(at / (2 * length));
  if (at > length) at = 2 * length - at;
  const double from_end = length - at;
  double value = at + (low - margin);
  if (at < 2 * margin) value = low + at * at / (4 * margin);
  if (from_end < 2 * margin) value = high - from_end * from_end / (4 * margin);
  return std::clamp(value, low, high);
}

double unbounded(double value, double low, double high) {
  const double margin = margin_of(low, high), inside = std::clamp(value, low, high);
  if (inside - low < margin) return low - margin + std::sqrt(4 * margin * (inside - low));
  if (high - inside < margin) return high + margin - std::sqrt(4 * margin * (high - inside));
  return inside;
}

}  // namespace mercury
