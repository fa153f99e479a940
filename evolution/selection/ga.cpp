// SPDX-License-Identifier: Apache-2.0
// A genetic algorithm with tournaments and elitism (Goldberg and Deb 1991; De Jong 1975): parents are the best of some
// that are drawn at random; of one generation only the elite lives on, with the best of its children.
#include <algorithm>
#include <cmath>

#include "evolution/selection/ranking.h"
#include "evolution/selection/registry.h"

namespace mercury {
namespace {

class GeneticAlgorithm : public Algorithm {
 public:
  explicit GeneticAlgorithm(const AlgorithmSettings& settings) : settings_(settings) {}

  std::vector<ChildPlan> plan(std::span<const Individual> living, std::size_t children, Random& random) const override {
    const auto precedes = [&](std::size_t a, std::size_t b) { return better(living[a], living[b]); };
    const auto draw = [&] { return tournament(living.size(), settings_.tournament, random, precedes); };
    std::vector<ChildPlan> plans;
    for (std::size_t i = 0; i < children; ++i)
      plans.push_back(plan_child(living.size(), settings_.crossover, random, draw));
    return plans;
  }

  // The elite of the living, then the best children, then, if those are too few, the next best of the living.
  std::vector<std::size_t> survivors(std::span<const Individual> pool, std::size_t living) const override {
    const auto elites =
        static_cast<std::size_t>(std::ceil(settings_.elites * static_cast<double>(settings_.population)));
    const std::vector<std::size_t> order = best_first(pool);
    std::vector<int> rank(pool.size(), 2);
    std::size_t elites_so_far = 0;
    for (const std::size_t i : order) rank[i] = i >= living ? 1 : elites_so_far++ < elites ? 0 : 2;
    std::vector<std::size_t> chosen = order;
    std::ranges::stable_sort(chosen, {}, [&](std::size_t i) { return rank[i]; });
    chosen.resize(std::min(chosen.size(), settings_.population));
    std::ranges::sort(chosen, [&](std::size_t a, std::size_t b) { return better(pool[a], pool[b]); });
    return chosen;
  }

 private:
  const AlgorithmSettings settings_;
};

}  // namespace

AlgorithmDescription ga() {
  return {.name = "ga",
          .help = "genetic algorithm: parents win tournaments, the elite lives on",
          .make = [](const AlgorithmSettings& settings) -> std::unique_ptr<Algorithm> {
            return std::make_unique<GeneticAlgorithm>(settings);
          }};
}

}  // namespace mercury
