// SPDX-License-Identifier: Apache-2.0
// Median and quartiles: how what is measured several times is reported.
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>
#include <span>
#include <vector>

namespace mercury {

// The quantile between the two nearest of sorted values (Hyndman and Fan's definition 7, as NumPy's default); NaN
// without values.
inline double quantile(std::span<const double> sorted, double share) {
  if (sorted.empty()) return std::numeric_limits<double>::quiet_NaN();
  const double position = share * static_cast<double>(sorted.size() - 1);
  const auto below = static_cast<std::size_t>(position);
  const double rest = position - static_cast<double>(below);
  if (rest == 0) return sorted[below];
  if (std::isinf(sorted[below])) return sorted[below];
  return sorted[below] + rest * (sorted[below + 1] - sorted[below]);
}

struct Spread {
  double lower_quartile = std::numeric_limits<double>::quiet_NaN();
  double median = lower_quartile, upper_quartile = lower_quartile;
  double between_quartiles() const { return upper_quartile - lower_quartile; }
  friend bool operator==(const Spread&, const Spread&) = default;
};

// All NaN if one of the values is.
inline Spread spread_of(std::vector<double> values) {
  if (std::ranges::any_of(values, [](double value) { return std::isnan(value); })) return {};
  std::ranges::sort(values);
  return {quantile(values, 0.25), quantile(values, 0.5), quantile(values, 0.75)};
}

// The mean in place of the median, and one standard error of it below and above in place of the quartiles. All NaN if
// one of the values is, or without values.
inline Spread mean_and_error(std::span<const double> values) {
  const auto count = static_cast<double>(values.size());
  double sum = 0, squares = 0;
  for (const double value : values) sum += value;
  const double mean = sum / count;
  for (const double value : values) squares += (value - mean) * (value - mean);
  const double error = values.size() > 1 ? std::sqrt(squares / (count - 1) / count) : 0;
  return {mean - error, mean, mean + error};
}

inline double median_of(std::vector<double> values) { return spread_of(std::move(values)).median; }

}  // namespace mercury
