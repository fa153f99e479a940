// SPDX-License-Identifier: Apache-2.0
// Orders and draws that algorithms share.
#pragma once

#include <cmath>
#include <cstddef>
#include <span>
#include <vector>

#include "mercury/algorithm.h"

namespace mercury {

// A score by which individuals can be sorted: NaN is the worst one.
inline double comparable(double score) { return std::isnan(score) ? worst_score : score; }

// Whether a stands before b: a higher first score, then the lower id.
inline bool better(const Individual& a, const Individual& b) {
  const double x = comparable(a.score()), y = comparable(b.score());
  return x != y ? x > y : a.id < b.id;
}

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

}  // namespace mercury
