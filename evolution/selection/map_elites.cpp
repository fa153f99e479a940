// SPDX-License-Identifier: Apache-2.0
// MAP-Elites (Mouret and Clune 2015, "Illuminating search spaces by mapping elites", figure 2): the space of some
// quantities is cut into cells; the best robot of each cell lives on, and every elite is as likely a parent. The cells
// are those of a grid, or of a centroidal Voronoi tessellation (Vassiliades, Chatzilygeroudis and Mouret 2018, "Using
// Centroidal Voronoi Tessellations to Scale Up the Multidimensional Archive of Phenotypic Elites Algorithm"), of which
// many axes do not need more.
#include <algorithm>
#include <cmath>
#include <unordered_set>

#include "evolution/selection/behavior.h"
#include "evolution/selection/elite_map.h"
#include "evolution/selection/ranking.h"
#include "evolution/selection/registry.h"
#include "mercury/quantity.h"

namespace mercury {
namespace {

std::size_t cell_on(const MapAxis& axis, double value) {
  const double place = (value - axis.lowest) / (axis.highest - axis.lowest) * axis.cells;
  if (!(place > 0)) return 0;  // NaN as well
  return static_cast<std::size_t>(std::min<double>(place, axis.cells - 1));
}

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
  const EliteMap map_;
};

}  // namespace

// Robots of the worst score get no cell, unless all have it: then those that are nearest to being sound do. What an
// exploded robot measured means nothing, so of those only the first one lives on, so that a run has always somebody.
std::vector<std::size_t> EliteMap::elites(std::span<const Individual> pool) const {
  const std::vector<std::size_t> order = best_first(pool);
  std::unordered_set<std::size_t> filled;
  std::vector<std::size_t> elites;
  const bool all_unsound = order.empty() || comparable(pool[order.front()].score()) == worst_score;
  for (const std::size_t i : order) {
    const Assessment& assessment = pool[i].assessment;
    const bool has_measured = assessment.violation > 0 && std::isfinite(assessment.violation);
    if (comparable(pool[i].score()) == worst_score && !(all_unsound && has_measured)) break;
    if (filled.insert(cell_of(pool[i])).second) elites.push_back(i);
  }
  if (elites.empty() && !order.empty()) elites.push_back(order.front());
  return elites;
}

std::size_t EliteMap::cell_of(const Individual& individual) const {
  const std::vector<double>& values = individual.assessment.values;
  if (settings_.niches == 0) return map_cell(settings_.axes, values);
  std::call_once(centers_made_, [&] { centers_ = centroids(settings_.axes.size(), settings_.niches); });
  Behavior behavior;
  for (const MapAxis& axis : settings_.axes) {
    const double value = values[find_quantity(axis.quantity).value()];
    const double place = (value - axis.lowest) / (axis.highest - axis.lowest);
    behavior.push_back(place > 0 ? std::min(place, 1.0) : 0);  // NaN is 0
  }
  return nearest_of(centers_, behavior);
}

std::size_t map_cell(std::span<const MapAxis> axes, std::span<const double> values) {
  std::size_t cell = 0, stride = 1;
  for (const MapAxis& axis : axes) {
    cell += stride * cell_on(axis, values[find_quantity(axis.quantity).value()]);
    stride *= static_cast<std::size_t>(axis.cells);
  }
  return cell;
}

std::size_t map_cells(const AlgorithmSettings& settings) {
  std::size_t cells = 1;
  for (const MapAxis& axis : settings.axes) cells *= static_cast<std::size_t>(axis.cells);
  return settings.niches > 0 ? settings.niches : cells;
}

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
