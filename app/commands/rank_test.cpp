// SPDX-License-Identifier: Apache-2.0
#include "app/commands/sweep.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <vector>

namespace mercury {
namespace {

// How many arrangements of `a` values among `b` others have u pairs in which the first is larger, for each u.
std::vector<double> arrangements(std::size_t a, std::size_t b) {
  // The largest of all is one of a, which beats all of b, or one of b.
  std::vector<std::vector<double>> of(b + 1, std::vector<double>{1});  // for i = 0 values of a, by b
  for (std::size_t i = 1; i <= a; ++i)
    for (std::size_t j = 0; j <= b; ++j) {
      std::vector<double> counts(i * j + 1);
      for (std::size_t u = 0; u < of[j].size(); ++u) counts[u + j] += of[j][u];
      if (j > 0)
        for (std::size_t u = 0; u < of[j - 1].size(); ++u) counts[u] += of[j - 1][u];
      of[j] = std::move(counts);
    }
  return of[b];
}

double exact(double u, std::size_t a, std::size_t b) {
  const std::vector<double> counts = arrangements(a, b);
  double all = 0, tail = 0;
  for (std::size_t i = 0; i < counts.size(); ++i) {
    all += counts[i];
    if (static_cast<double>(i) <= u) tail += counts[i];
  }
  return std::min(1.0, 2 * tail / all);
}

}  // namespace

double rank_test(std::span<const double> a, std::span<const double> b) {
  constexpr std::size_t most_exact = 20;
  if (a.empty() || b.empty()) return 1;
  double larger = 0;
  for (const double x : a)
    for (const double y : b) larger += x > y ? 1 : x == y ? 0.5 : 0;
  const double m = static_cast<double>(a.size()), n = static_cast<double>(b.size()),
               u = std::min(larger, m * n - larger);
  std::vector<double> all(a.begin(), a.end());
  all.insert(all.end(), b.begin(), b.end());
  std::ranges::sort(all);
  double ties = 0;  // sum of t^3 - t over groups of t equal values
  for (std::size_t i = 0; i < all.size();) {
    const auto end = static_cast<std::size_t>(std::ranges::upper_bound(all, all[i]) - all.begin());
    const auto t = static_cast<double>(end - i);
    ties += t * t * t - t;
    i = end;
  }
  if (ties == 0 && a.size() <= most_exact && b.size() <= most_exact) return exact(u, a.size(), b.size());
  const double both = m + n, variance = m * n / 12 * (both + 1 - ties / (both * (both - 1)));
  if (!(variance > 0)) return 1;
  const double z = std::max(0.0, m * n / 2 - u - 0.5) / std::sqrt(variance);
  return std::erfc(z / std::numbers::sqrt2);
}

}  // namespace mercury
