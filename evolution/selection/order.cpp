// SPDX-License-Identifier: Apache-2.0
#include "evolution/selection/order.h"

#include <algorithm>
#include <numeric>

namespace mercury {

std::vector<std::size_t> best_first(std::span<const Individual> individuals) {
  std::vector<std::size_t> order(individuals.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::ranges::sort(order, [&](std::size_t a, std::size_t b) { return better(individuals[a], individuals[b]); });
  return order;
}

}  // namespace mercury
