// SPDX-License-Identifier: Apache-2.0
// The map of map-elites and CMA-ME: the best robot of each cell lives on.
#pragma once

#include <cstddef>
#include <mutex>
#include <span>
#include <vector>

#include "evolution/selection/behavior.h"
#include "mercury/algorithm.h"

namespace mercury {

class EliteMap {
 public:
  explicit EliteMap(const AlgorithmSettings& settings) : settings_(settings) {}

  // Indices in the pool, the best first.
  std::vector<std::size_t> elites(std::span<const Individual> pool) const;
  // Of an individual that was measured.
  std::size_t cell_of(const Individual& individual) const;

 private:
  const AlgorithmSettings settings_;
  mutable std::once_flag centers_made_;
  mutable std::vector<Behavior> centers_;
};

}  // namespace mercury
