// SPDX-License-Identifier: Apache-2.0
// Pareto dominance. A point is a row of values of which more is better.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

namespace mercury {

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
