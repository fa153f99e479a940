// SPDX-License-Identifier: Apache-2.0
// Rankings and random choices that several algorithms use.
#pragma once

#include <cmath>
#include <compare>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "mercury/algorithm.h"

namespace mercury {

// A score by which individuals can be sorted: NaN is the worst one.
inline double comparable(double score) { return std::isnan(score) ? worst_score : score; }

// What decides which of two individuals stands before the other: a higher first score; of those that have the worst,
// being nearer to sound, so that a search among robots that are not sound leads to some that are; then the lower id.
struct RankingKey {
  double score = 0, violation = 0;
  std::uint64_t id = 0;

  explicit RankingKey(const Individual& individual)
      : score(comparable(individual.score())), violation(individual.assessment.violation), id(individual.id) {}
  bool is_before(const RankingKey& other) const {
    if (score != other.score) return score > other.score;
    return violation != other.violation ? violation < other.violation : id < other.id;
  }
};
inline bool better(const Individual& a, const Individual& b) { return RankingKey(a).is_before(RankingKey(b)); }

// Which of two individuals is fitter: the one that is as good in every objective and better in one; `unordered` if
// each is better in one.
std::partial_ordering compare_fitness(const Individual& a, const Individual& b);

// Indices of the individuals, the best first.
std::vector<std::size_t> best_first(std::span<const Individual> individuals);

// A child of one of the living, or with probability `crossover` of two different ones. `draw()` returns the index of a
// parent; without living ones, the child is random. After some draws that repeat the first parent, the second one is
// drawn uniformly from the others.
template <class Draw>
ChildPlan plan_child(std::size_t living, double crossover, Random& random, Draw&& draw) {
  if (living == 0) return {};
  const std::size_t first = draw();
  if (!random.chance(crossover) || living == 1) return {{first}};
  for (int attempt = 0; attempt < 8; ++attempt)
    if (const std::size_t second = draw(); second != first) return {{first, second}};
  return {{first, (first + 1 + random.below(living - 1)) % living}};
}

// The best of `size` indices below `count`, drawn with replacement; `precedes(a, b)` says whether a is better.
template <class Precedes>
std::size_t tournament(std::size_t count, int size, Random& random, Precedes&& precedes) {
  std::size_t best = random.below(count);
  for (int i = 1; i < size; ++i)
    if (const std::size_t other = random.below(count); precedes(other, best)) best = other;
  return best;
}

// Pareto dominance. A point is a row of values of which more is better.

// Points as rows of one array.
struct Points {
  std::size_t dimensions = 1;
  std::vector<double> values;  // no NaN
  std::size_t size() const { return values.size() / dimensions; }
  std::span<const double> operator[](std::size_t i) const {
    return std::span(values).subspan(i * dimensions, dimensions);
  }
};

// Whether a is at least as good as b in every value and better in one (Deb 2002, III.A).
bool dominates(std::span<const double> a, std::span<const double> b);

// The fronts of the points: front 0 is what no point dominates, front 1 what only points of front 0 dominate, and so
// on. Indices in a front ascend. It is the result of Deb's fast non-dominated sort, found as in Zhang, Tian, Cheng and
// Jin 2015 (ENS-BS): points in lexicographic order are inserted into the first front of which no member dominates them,
// by a binary search. In two dimensions the last member of a front decides, so n points take n log n steps.
std::vector<std::vector<std::size_t>> fronts_of(const Points& points);

// Crowding distance of each member of a front (Deb et al. 2002, III.B): the sum over the dimensions of the difference
// between its two neighbors, divided by the range of the front. Members at either end of a dimension have an infinite
// one; of equal values at an end, it is that of the lowest index at the low end and of the highest at the high end.
// Infinite values have no influence on the range.
std::vector<double> crowding_distances(const Points& points, std::span<const std::size_t> front);

}  // namespace mercury
