// SPDX-License-Identifier: Apache-2.0
#include "evolution/selection/behavior.h"

#include <cmath>

#include "evolution/selection/ranking.h"
#include "mercury/parallel.h"
#include "mercury/quantity.h"
#include "mercury/random.h"

namespace mercury {

std::optional<Behavior> behavior_of(std::span<const MapAxis> axes, const Individual& individual) {
  const std::vector<double>& values = individual.assessment.values;
  if (comparable(individual.score()) == worst_score || values.empty()) return std::nullopt;
  Behavior behavior;
  for (const MapAxis& axis : axes) {
    const double value = values[find_quantity(axis.quantity).value()];
    if (!std::isfinite(value)) return std::nullopt;
    behavior.push_back((value - axis.lowest) / (axis.highest - axis.lowest));
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

}  // namespace mercury
