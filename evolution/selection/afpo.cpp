// SPDX-License-Identifier: Apache-2.0
// Age-fitness Pareto optimization (Schmidt and Lipson 2011, "Age-Fitness Pareto Optimization", section 2.3). An
// individual's age is the number of generations since its oldest ancestor was drawn. Each generation has one new random
// individual of age 0; individuals that are dominated in (age, score) go, so young lines compete with each other and
// not with old ones that had more time.
//
// Schmidt and Lipson remove dominated individuals that lose random tournaments. Here whole fronts live on, the first
// ones first; of the front that does not fit, the best. That needs no draws, so a pool decides alone who lives on. Of
// individuals equal in age and score only the one of the lowest id counts as not dominated.
#include <algorithm>

#include "evolution/selection/ranking.h"
#include "evolution/selection/registry.h"

namespace mercury {
namespace {

constexpr double uniform_share = 0.5;  // of the parents

class AgeFitnessPareto : public Algorithm {
 public:
  explicit AgeFitnessPareto(const AlgorithmSettings& settings) : settings_(settings) {}

  // Schmidt and Lipson draw parents uniformly. So does this for half of them; that lets young lines grow. The others
  // win tournaments: with uniform draws alone, a run of 20 generations gets less far (docs/experiments.md).
  std::vector<ChildPlan> plan(std::span<const Individual> living, std::size_t children, Random& random) const override {
    const auto precedes = [&](std::size_t a, std::size_t b) { return better(living[a], living[b]); };
    const auto draw = [&] {
      return random.chance(uniform_share) ? random.below(living.size())
                                          : tournament(living.size(), settings_.tournament, random, precedes);
    };
    std::vector<ChildPlan> plans;
    for (std::size_t i = 0; i + 1 < children; ++i)
      plans.push_back(plan_child(living.size(), settings_.crossover, random, draw));
    if (children > 0) plans.emplace_back();  // random
    return plans;
  }

  std::vector<std::size_t> survivors(std::span<const Individual> pool, std::size_t) const override {
    const std::vector<std::size_t> order = best_first(pool);
    std::vector<std::size_t> chosen;
    for (const std::vector<std::size_t>& front : fronts_of(youth_and_rank(pool, order))) {
      // A front's places are in the order of the scores.
      for (const std::size_t place : front)
        if (chosen.size() < settings_.population) chosen.push_back(place);
      if (chosen.size() == settings_.population) break;
    }
    std::ranges::sort(chosen);
    for (std::size_t& place : chosen) place = order[place];
    return chosen;
  }

 private:
  // Per place in the order: how late its line began, and minus its place, which no two have in common.
  static Points youth_and_rank(std::span<const Individual> pool, std::span<const std::size_t> order) {
    Points points{.dimensions = 2, .values = {}};
    for (std::size_t place = 0; place < order.size(); ++place)
      points.values.insert(points.values.end(),
                           {static_cast<double>(pool[order[place]].line_began), -static_cast<double>(place)});
    return points;
  }

  const AlgorithmSettings settings_;
};

}  // namespace

AlgorithmDescription afpo() {
  return {.name = "afpo",
          .help =
              "age-fitness Pareto optimization: young lines compete with young ones; one new random robot per "
              "generation",
          .make = [](const AlgorithmSettings& settings) -> std::unique_ptr<Algorithm> {
            return std::make_unique<AgeFitnessPareto>(settings);
          }};
}

}  // namespace mercury
