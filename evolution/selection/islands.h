// SPDX-License-Identifier: Apache-2.0
// The island model (Whitley, Rana and Heckendorn 1999, "The Island Model Genetic Algorithm: On Separability, Population
// Size and Convergence"; Cantu-Paz 1998, "A Survey of Parallel Genetic Algorithms", of several demes): the population
// is split into islands. On each the algorithm runs by itself, so that a good robot does not take over all of them at
// once. Now and then the best of each island come to the next one in a ring, where they replace the worst:
//
//     island     0 --> 1 --> 2 --> 3 --> 0          in generations N, 2 N, 3 N, ...; N = migration_interval
//
// A migrant is a copy of its parent: a robot of its own in the lineage, born on the other island, which is tried as
// all are and is one of the children of its generation. It may have children in the next one. What an island does
// depends on the run's seed, its own number and who came to it, and on nothing else of the other islands.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "mercury/algorithm.h"

namespace mercury {

class Islands {
 public:
  // `custom` = in place of the algorithm of the settings, on one island. Throws as make_algorithm().
  explicit Islands(const AlgorithmSettings& settings, std::unique_ptr<Algorithm> custom = nullptr);

  // Of one island: the algorithm itself, which may learn.
  Algorithm& algorithm() const { return *algorithms_.front(); }

  // On which island a child is born, by its place among all children of its generation.
  std::size_t island_of(std::size_t place) const { return place % algorithms_.size(); }
  // As of Algorithm; `seed` is that of the generation's random numbers.
  std::vector<ChildPlan> plan(int generation, std::span<const Individual> living, std::size_t children,
                              std::uint64_t seed) const;
  std::vector<std::size_t> survivors(std::span<const Individual> pool, std::size_t living) const;
  // Of all islands together.
  std::size_t species(std::span<const Individual> living) const;

 private:
  // How many of `count` places are those of an island.
  std::size_t share_of(std::size_t count, std::size_t island) const;
  bool is_migration(int generation) const;

  const AlgorithmSettings settings_;
  std::vector<std::unique_ptr<Algorithm>> algorithms_;  // per island, with its population
  std::unique_ptr<Algorithm> all_;  // with the whole population; only of several objectives, whose order it knows
};

}  // namespace mercury
