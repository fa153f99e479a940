// SPDX-License-Identifier: Apache-2.0
// NSGA-II (Deb, Pratap, Agarwal and Meyarivan 2002, "A fast and elitist multiobjective genetic algorithm: NSGA-II"):
// parents and children compete by the front they are in, and within a front by their crowding distance.
#include <algorithm>
#include <limits>
#include <numeric>

#include "evolution/selection/ranking.h"
#include "evolution/selection/registry.h"

namespace mercury {
namespace {

struct Standing {
  std::vector<std::size_t> front;  // per individual
  std::vector<double> crowding;
};

Points scores_of(std::span<const Individual> pool) {
  std::size_t objectives = 1;
  for (const Individual& individual : pool) objectives = std::max(objectives, individual.assessment.scores.size());
  Points points{.dimensions = objectives, .values = std::vector<double>(pool.size() * objectives, worst_score)};
  for (std::size_t i = 0; i < pool.size(); ++i)
    std::ranges::transform(pool[i].assessment.scores,
                           points.values.begin() + static_cast<std::ptrdiff_t>(i * objectives), comparable);
  return points;
}

// Of robots that are not sound, the one that breaks the limits less dominates, and every sound one dominates them (VI,
// constrained domination).
std::vector<std::vector<std::size_t>> constrained_fronts(std::span<const Individual> pool, const Points& points) {
  const auto violation = [](const Individual& individual) { return individual.assessment.violation; };
  if (std::ranges::none_of(
          pool, [](double v) { return v > 0; }, violation))
    return fronts_of(points);
  Points constrained{.dimensions = points.dimensions + 1, .values = {}};
  for (std::size_t i = 0; i < pool.size(); ++i) {
    constrained.values.insert(constrained.values.end(), points[i].begin(), points[i].end());
    constrained.values.push_back(-violation(pool[i]));
  }
  return fronts_of(constrained);
}

Standing standing_of(std::span<const Individual> pool, const Points& points) {
  Standing standing{std::vector<std::size_t>(pool.size()), std::vector<double>(pool.size())};
  std::size_t rank = 0;
  for (std::vector<std::size_t>& front : constrained_fronts(pool, points)) {
    std::ranges::sort(front, {}, [&](std::size_t i) { return pool[i].id; });
    const std::vector<double> crowding = crowding_distances(points, front);
    for (std::size_t k = 0; k < front.size(); ++k) {
      standing.front[front[k]] = rank;
      standing.crowding[front[k]] = crowding[k];
    }
    ++rank;
  }
  return standing;
}

class Nsga2 : public Algorithm {
 public:
  explicit Nsga2(const AlgorithmSettings& settings) : settings_(settings) {}

  // Binary tournaments by the crowded-comparison operator (III.B).
  std::vector<ChildPlan> plan(std::span<const Individual> living, std::size_t children, Random& random) const override {
    const Standing standing = standing_of(living, scores_of(living));
    const auto precedes = [&](std::size_t a, std::size_t b) {
      if (standing.front[a] != standing.front[b]) return standing.front[a] < standing.front[b];
      if (standing.crowding[a] != standing.crowding[b]) return standing.crowding[a] > standing.crowding[b];
      return living[a].id < living[b].id;
    };
    std::vector<ChildPlan> plans;
    for (std::size_t i = 0; i < children; ++i)
      plans.push_back(plan_child(living.size(), settings_.crossover, random,
                                 [&] { return tournament(living.size(), 2, random, precedes); }));
    return plans;
  }

  // The main loop of III.C. Of equal front and crowding, the better first score goes first.
  std::vector<std::size_t> survivors(std::span<const Individual> pool, std::size_t) const override {
    const Standing standing = standing_of(pool, scores_of(pool));
    std::vector<std::size_t> order(pool.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::ranges::sort(order, [&](std::size_t a, std::size_t b) {
      if (standing.front[a] != standing.front[b]) return standing.front[a] < standing.front[b];
      if (standing.crowding[a] != standing.crowding[b]) return standing.crowding[a] > standing.crowding[b];
      return better(pool[a], pool[b]);
    });
    order.resize(std::min(order.size(), settings_.population));
    return order;
  }

 private:
  const AlgorithmSettings settings_;
};

}  // namespace

AlgorithmDescription nsga2() {
  return {.name = "nsga2",
          .help = "NSGA-II: several objectives; what no other robot beats in all of them lives on",
          .many_objectives = true,
          .make = [](const AlgorithmSettings& settings) -> std::unique_ptr<Algorithm> {
            return std::make_unique<Nsga2>(settings);
          }};
}

}  // namespace mercury
