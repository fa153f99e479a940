// SPDX-License-Identifier: Apache-2.0
// Novelty search (Lehman and Stanley 2011, "Abandoning Objectives: Evolution Through the Search for Novelty Alone"):
// who does what others do not lives on and has children, whatever its score. A robot's novelty is the mean distance
// from its nearest neighbors among the living, their children and an archive, in the space of some quantities.
//
// Some robots of each generation come into the archive, drawn at random (Gomes, Mariano and Christensen 2015 find that
// as good as a threshold of novelty, and it needs none). The one robot of the best score always lives on, so that a run
// does not lose what it found.
#include <algorithm>
#include <cmath>
#include <optional>

#include "evolution/selection/behavior.h"
#include "evolution/selection/ranking.h"
#include "evolution/selection/registry.h"
#include "mercury/parallel.h"

namespace mercury {
namespace {

class NoveltySearch : public Algorithm {
 public:
  explicit NoveltySearch(const AlgorithmSettings& settings) : settings_(settings) {}

  std::vector<ChildPlan> plan(std::span<const Individual> living, std::size_t children, Random& random) const override {
    const std::vector<double> novelty = novelty_of(living);
    const auto precedes = [&](std::size_t a, std::size_t b) { return is_newer(living, novelty, a, b); };
    std::vector<ChildPlan> plans;
    for (std::size_t i = 0; i < children; ++i)
      plans.push_back(plan_child(living.size(), settings_.crossover, random,
                                 [&] { return tournament(living.size(), settings_.tournament, random, precedes); }));
    return plans;
  }

  std::vector<std::size_t> survivors(std::span<const Individual> pool, std::size_t) const override {
    std::vector<std::size_t> order = best_first(pool);
    if (order.empty()) return order;
    const std::vector<double> novelty = novelty_of(pool);
    // The best stays where it is, at the front.
    std::sort(order.begin() + 1, order.end(),
              [&](std::size_t a, std::size_t b) { return is_newer(pool, novelty, a, b); });
    order.resize(std::min(order.size(), settings_.population));
    std::ranges::sort(order, [&](std::size_t a, std::size_t b) { return better(pool[a], pool[b]); });
    return order;
  }

  void begin(std::span<const double>, double) override { archive_.clear(); }
  void learn(std::span<const Individual> born, Random random) override {
    std::vector<Behavior> known;
    for (const Individual& individual : born)
      if (std::optional<Behavior> behavior = behavior_of(settings_.axes, individual))
        known.push_back(*std::move(behavior));
    for (std::size_t i = 0; i < settings_.archived && !known.empty(); ++i) {
      std::swap(known[random.below(known.size())], known.back());
      archive_.push_back(std::move(known.back()));
      known.pop_back();
    }
  }

 private:
  // Of robots without a behavior, -1.
  std::vector<double> novelty_of(std::span<const Individual> pool) const {
    std::vector<std::optional<Behavior>> own;
    for (const Individual& individual : pool) own.push_back(behavior_of(settings_.axes, individual));
    std::vector<double> novelty(pool.size(), -1);
    parallel_for(0, pool.size(), [&](std::size_t i) {
      if (!own[i]) return;
      std::vector<double> distances;
      for (std::size_t k = 0; k < own.size(); ++k)
        if (k != i && own[k]) distances.push_back(squared_distance(*own[i], *own[k]));
      for (const Behavior& other : archive_) distances.push_back(squared_distance(*own[i], other));
      const std::size_t count = std::min(distances.size(), static_cast<std::size_t>(settings_.neighbors));
      std::ranges::partial_sort(distances, distances.begin() + static_cast<std::ptrdiff_t>(count));
      double sum = 0;
      for (std::size_t k = 0; k < count; ++k) sum += std::sqrt(distances[k]);
      novelty[i] = count > 0 ? sum / static_cast<double>(count) : 0;
    });
    return novelty;
  }

  static bool is_newer(std::span<const Individual> pool, std::span<const double> novelty, std::size_t a,
                       std::size_t b) {
    return novelty[a] != novelty[b] ? novelty[a] > novelty[b] : better(pool[a], pool[b]);
  }

  const AlgorithmSettings settings_;
  std::vector<Behavior> archive_;
};

}  // namespace

AlgorithmDescription novelty_search() {
  return {.name = "novelty",
          .help = "novelty search: whoever does what no other robot does lives on, whatever its score",
          .of_behavior = true,
          .learns = true,
          .make = [](const AlgorithmSettings& settings) -> std::unique_ptr<Algorithm> {
            return std::make_unique<NoveltySearch>(settings);
          }};
}

}  // namespace mercury
