// SPDX-License-Identifier: Apache-2.0
// Times of calls that take turns.
#pragma once

#include <algorithm>
#include <cstddef>
#include <vector>

#include "mercury/stopwatch.h"

namespace mercury {

inline double seconds_of(const auto& call) {
  const double start = wall_now();
  call();
  return wall_now() - start;
}

inline double median(std::vector<double> values) {
  std::ranges::nth_element(values, values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2));
  return values[values.size() / 2];
}

}  // namespace mercury
