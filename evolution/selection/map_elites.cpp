// SPDX-License-Identifier: Apache-2.0
// MAP-Elites (Mouret and Clune 2015, "Illuminating search spaces by mapping elites", figure 2): the space of some
// quantities is cut into cells; the best robot of each cell lives on, and every elite is as likely a parent. The cells
// are those of a grid, or of a centroidal Voronoi tessellation (Vassiliades, Chatzilygeroudis and Mouret 2018, "Using
// Centroidal Voronoi Tessellations to Scale Up the Multidimensional Archive of Phenotypic Elites Algorithm"), of which
// many axes do not need more.
#include "evolution/selection/behavior.h"
#include "evolution/selection/ranking.h"
#include "evolution/selection/registry.h"

namespace mercury {
namespace {

class MapElites : public Algorithm {
 public:
  explicit MapElites(const AlgorithmSettings& settings) : settings_(settings), map_(settings) {}

  std::vector<ChildPlan> plan(std::span<const Individual> living, std::size_t children, Random& random) const override {
    std::vector<ChildPlan> plans;
    for (std::size_t i = 0; i < children; ++i)
      plans.push_back(
          plan_child(living.size(), settings_.crossover, random, [&] { return random.below(living.size()); }));
    return plans;
  }

  std::vector<std::size_t> survivors(std::span<const Individual> pool, std::size_t) const override {
    return map_.elites(pool);
  }

 private:
  const AlgorithmSettings settings_;
  const CellMap map_;
};

}  // namespace

AlgorithmDescription map_elites() {
  return {.name = "map-elites",
          .help = "MAP-Elites: the best robot for each cell of a map of their properties",
          .of_behavior = true,
          .has_map = true,
          .make = [](const AlgorithmSettings& settings) -> std::unique_ptr<Algorithm> {
            return std::make_unique<MapElites>(settings);
          }};
}

}  // namespace mercury
