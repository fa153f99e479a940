// SPDX-License-Identifier: Apache-2.0
#include "evolution/selection/ranking.h"

#include <algorithm>
#include <limits>
#include <numeric>
#include <utility>

namespace mercury {

std::partial_ordering compare_fitness(const Individual& a, const Individual& b) {
  const std::vector<double>&x = a.assessment.scores, &y = b.assessment.scores;
  bool a_is_better = false, b_is_better = false;
  for (std::size_t i = 0; i < std::min(x.size(), y.size()); ++i) {
    a_is_better |= comparable(x[i]) > comparable(y[i]);
    b_is_better |= comparable(y[i]) > comparable(x[i]);
  }
  if (a_is_better && b_is_better) return std::partial_ordering::unordered;
  return a_is_better   ? std::partial_ordering::greater
         : b_is_better ? std::partial_ordering::less
                       : std::partial_ordering::equivalent;
}

std::vector<std::size_t> best_first(std::span<const Individual> individuals) {
  // Individuals and their scores are all over the memory, so what is compared is brought together first.
  std::vector<std::pair<RankingKey, std::size_t>> keys;
  keys.reserve(individuals.size());
  for (const Individual& individual : individuals) keys.emplace_back(RankingKey(individual), keys.size());
  std::ranges::sort(keys, [](const auto& a, const auto& b) { return a.first.is_before(b.first); });
  std::vector<std::size_t> order;
  order.reserve(keys.size());
  for (const auto& [key, index] : keys) order.push_back(index);
  return order;
}

namespace {

constexpr double infinite = std::numeric_limits<double>::infinity();

// Highest first values first; of equal ones the highest second values, and so on; then by index.
std::vector<std::size_t> lexicographic_order(const Points& points) {
  std::vector<std::size_t> order(points.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::ranges::sort(order, [&](std::size_t a, std::size_t b) {
    const auto x = points[a], y = points[b];
    const auto [p, q] = std::ranges::mismatch(x, y);
    return p == x.end() ? a < b : *p > *q;
  });
  return order;
}

// Whether a member of the front dominates the point, which comes after all of them in lexicographic order.
bool front_dominates(const Points& points, std::span<const std::size_t> front, std::size_t point) {
  // In two dimensions second values never fall along a front, so its last member has the highest one.
  if (points.dimensions <= 2) return dominates(points[front.back()], points[point]);
  return std::any_of(front.rbegin(), front.rend(),
                     [&](std::size_t member) { return dominates(points[member], points[point]); });
}

// Difference of neighbors as a share of the range.
double gap(double low, double high, double range) {
  if (low == high) return 0;
  if (!std::isfinite(low) || !std::isfinite(high)) return infinite;
  return (high - low) / range;
}

double finite_range(const Points& points, std::span<const std::size_t> front, std::size_t dimension) {
  double lowest = infinite, highest = -infinite;
  for (const std::size_t i : front) {
    const double value = points[i][dimension];
    if (!std::isfinite(value)) continue;
    lowest = std::min(lowest, value);
    highest = std::max(highest, value);
  }
  return highest - lowest;
}

}  // namespace

bool dominates(std::span<const double> a, std::span<const double> b) {
  bool is_better = false;
  for (std::size_t d = 0; d < a.size(); ++d) {
    if (a[d] < b[d]) return false;
    is_better |= a[d] > b[d];
  }
  return is_better;
}

std::vector<std::vector<std::size_t>> fronts_of(const Points& points) {
  std::vector<std::vector<std::size_t>> fronts;
  for (const std::size_t point : lexicographic_order(points)) {
    const auto front = std::ranges::partition_point(
        fronts, [&](const std::vector<std::size_t>& members) { return front_dominates(points, members, point); });
    if (front == fronts.end())
      fronts.push_back({point});
    else
      front->push_back(point);
  }
  for (std::vector<std::size_t>& front : fronts) std::ranges::sort(front);
  return fronts;
}

std::vector<double> crowding_distances(const Points& points, std::span<const std::size_t> front) {
  std::vector<double> distances(front.size(), 0);
  if (front.empty()) return distances;
  std::vector<std::size_t> order(front.size());
  for (std::size_t dimension = 0; dimension < points.dimensions; ++dimension) {
    const auto value = [&](std::size_t k) { return points[front[order[k]]][dimension]; };
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::ranges::stable_sort(order, {}, [&](std::size_t k) { return points[front[k]][dimension]; });
    const double range = finite_range(points, front, dimension);
    distances[order.front()] = distances[order.back()] = infinite;
    for (std::size_t k = 1; k + 1 < order.size(); ++k) distances[order[k]] += gap(value(k - 1), value(k + 1), range);
  }
  return distances;
}

}  // namespace mercury
