// SPDX-License-Identifier: Apache-2.0
#include "evolution/selection/behavior.h"

#include <algorithm>
#include <cmath>
#include <unordered_set>

#include "evolution/selection/ranking.h"
#include "mercury/parallel.h"
#include "mercury/quantity.h"
#include "mercury/random.h"

namespace mercury {
namespace {

// 0 at the lowest value of the axis, 1 at the highest.
double place_on(const MapAxis& axis, std::span<const double> values) {
  return (values[find_quantity(axis.quantity).value()] - axis.lowest) / (axis.highest - axis.lowest);
}

}  // namespace

std::optional<Behavior> behavior_of(std::span<const MapAxis> axes, const Individual& individual) {
  const std::vector<double>& values = individual.assessment.values;
  if (comparable(individual.score()) == worst_score || values.empty()) return std::nullopt;
  Behavior behavior;
  for (const MapAxis& axis : axes) {
    const double place = place_on(axis, values);
    if (!std::isfinite(place)) return std::nullopt;
    behavior.push_back(place);
  }
  return behavior;
}

double squared_distance(std::span<const double> a, std::span<const double> b) {
  double sum = 0;
  for (std::size_t i = 0; i < a.size(); ++i) sum += (a[i] - b[i]) * (a[i] - b[i]);
  return sum;
}

std::size_t nearest_of(std::span<const Behavior> points, std::span<const double> to) {
  std::size_t nearest = 0;
  double least = squared_distance(points[0], to);
  for (std::size_t i = 1; i < points.size(); ++i)
    if (const double distance = squared_distance(points[i], to); distance < least) nearest = i, least = distance;
  return nearest;
}

std::vector<Behavior> centroids(std::size_t dimensions, std::size_t cells) {
  constexpr std::size_t samples_per_cell = 25;
  constexpr int rounds = 25;
  Random random(0);
  const auto drawn = [&](std::size_t count) {
    std::vector<Behavior> points(count, Behavior(dimensions));
    for (Behavior& point : points)
      for (double& value : point) value = random.uniform();
    return points;
  };
  const std::vector<Behavior> samples = drawn(samples_per_cell * cells);
  std::vector<Behavior> centers = drawn(cells);
  std::vector<std::size_t> cell_of(samples.size());
  for (int round = 0; round < rounds; ++round) {
    parallel_for(0, samples.size(), [&](std::size_t i) { cell_of[i] = nearest_of(centers, samples[i]); });
    std::vector<Behavior> sums(cells, Behavior(dimensions, 0));
    std::vector<std::size_t> counts(cells, 0);
    for (std::size_t i = 0; i < samples.size(); ++i) {
      ++counts[cell_of[i]];
      for (std::size_t k = 0; k < dimensions; ++k) sums[cell_of[i]][k] += samples[i][k];
    }
    for (std::size_t cell = 0; cell < cells; ++cell)
      for (std::size_t k = 0; counts[cell] > 0 && k < dimensions; ++k)
        centers[cell][k] = sums[cell][k] / static_cast<double>(counts[cell]);
  }
  return centers;
}

std::size_t map_cell(std::span<const MapAxis> axes, std::span<const double> values) {
  std::size_t cell = 0, stride = 1;
  for (const MapAxis& axis : axes) {
    const double place = place_on(axis, values) * axis.cells;
    if (place > 0) cell += stride * static_cast<std::size_t>(std::min<double>(place, axis.cells - 1));  // NaN is 0
    stride *= static_cast<std::size_t>(axis.cells);
  }
  return cell;
}

std::size_t map_cells(const AlgorithmSettings& settings) {
  std::size_t cells = 1;
  for (const MapAxis& axis : settings.axes) cells *= static_cast<std::size_t>(axis.cells);
  return settings.niches > 0 ? settings.niches : cells;
}

std::size_t CellMap::cell_of(const Individual& individual) const {
  const std::vector<double>& values = individual.assessment.values;
  if (settings_.niches == 0) return map_cell(settings_.axes, values);
  std::call_once(centers_made_, [&] { centers_ = centroids(settings_.axes.size(), settings_.niches); });
  Behavior behavior;
  for (const MapAxis& axis : settings_.axes) {
    const double place = place_on(axis, values);
    behavior.push_back(place > 0 ? std::min(place, 1.0) : 0);  // NaN is 0
  }
  return nearest_of(centers_, behavior);
}

std::vector<std::size_t> CellMap::elites(std::span<const Individual> pool) const {
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

}  // namespace mercury
