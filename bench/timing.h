// SPDX-License-Identifier: Apache-2.0
// Times of calls that take turns.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdio>
#include <cstdlib>
#include <optional>
#include <vector>

#include "mercury/number_text.h"
#include "mercury/stopwatch.h"

namespace mercury {

inline double seconds_of(const auto& call) {
  const double start = wall_now();
  call();
  return wall_now() - start;
}

// A time on the command line [s]. Ends the program if it is none.
inline double seconds_from(const char* text) {
  const std::optional<double> seconds = parse_number<double>(text);
  if (seconds && *seconds > 0 && std::isfinite(*seconds)) return *seconds;
  std::fprintf(stderr, "%s is not accepted as a time; give seconds, a number > 0\n", text);
  std::exit(2);
}

inline double median(std::vector<double> values) {
  std::ranges::nth_element(values, values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2));
  return values[values.size() / 2];
}

}  // namespace mercury
