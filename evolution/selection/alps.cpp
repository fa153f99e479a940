// SPDX-License-Identifier: Apache-2.0
// ALPS, the age-layered population structure (Hornby 2006, "ALPS: The Age-Layered Population Structure for Reducing the
// Problem of Premature Convergence"): robots compete within layers, each of which has a limit of age, and new random
// robots come into the lowest one all the time, so that they need not compete with lines that had more time. An
// individual's age is the number of generations since its oldest ancestor was drawn. Whoever is too old for its layer,
// or not among its best, tries the next one.
//
// Hornby's lowest layer is replaced by random robots every `age_gap` generations. Here as many come, but a share of
// them in each generation (as in his steady-state ALPS of 2009), so nothing depends on which generation it is.
#include <algorithm>
#include <limits>

#include "evolution/selection/ranking.h"
#include "evolution/selection/registry.h"

namespace mercury {
namespace {

class AgeLayers : public Algorithm {
 public:
  explicit AgeLayers(const AlgorithmSettings& settings) : settings_(settings) {}

  // As many children for each layer. Their parents are the best of some that are drawn from the layer and the one
  // below.
  std::vector<ChildPlan> plan(std::span<const Individual> living, std::size_t children, Random& random) const override {
    const Layers layers = layers_of(living);
    Layers candidates = layers;
    for (std::size_t layer = 1; layer < layers.size(); ++layer)
      candidates[layer].insert(candidates[layer].end(), layers[layer - 1].begin(), layers[layer - 1].end());
    std::vector<ChildPlan> plans;
    for (std::size_t i = 0; i < children; ++i) {
      const std::size_t layer = i % layers.size();
      const std::vector<std::size_t>& parents = candidates[layer];
      if (parents.empty() || (layer == 0 && i / layers.size() < newcomers())) {
        plans.emplace_back();
        continue;
      }
      plans.push_back(plan_child(parents.size(), settings_.crossover, random, [&] {
        return tournament(parents.size(), settings_.tournament, random,
                          [&](std::size_t a, std::size_t b) { return better(living[parents[a]], living[parents[b]]); });
      }));
      for (std::size_t& parent : plans.back().parents) parent = parents[parent];
    }
    return plans;
  }

  std::vector<std::size_t> survivors(std::span<const Individual> pool, std::size_t) const override {
    std::vector<std::size_t> chosen;
    for (const std::vector<std::size_t>& layer : layers_of(pool))
      chosen.insert(chosen.end(), layer.begin(), layer.end());
    std::ranges::sort(chosen, [&](std::size_t a, std::size_t b) { return better(pool[a], pool[b]); });
    return chosen;
  }

 private:
  using Layers = std::vector<std::vector<std::size_t>>;  // the best of each first

  std::size_t layer_count() const {
    return std::min(static_cast<std::size_t>(settings_.age_layers), settings_.population);
  }
  // The upper ones are the larger ones, if they cannot be equal.
  std::size_t capacity(std::size_t layer) const { return (settings_.population + layer) / layer_count(); }
  std::size_t newcomers() const {
    const auto gap = static_cast<std::size_t>(settings_.age_gap);
    return (capacity(0) + gap - 1) / gap;
  }
  // Below which ages belong into a layer: the gap times 1, 2, 4, 9, 16, ... (Hornby's polynomial scheme).
  int age_limit(std::size_t layer) const {
    if (layer + 1 >= layer_count()) return std::numeric_limits<int>::max();
    const int place = static_cast<int>(layer);
    return settings_.age_gap * (place < 2 ? place + 1 : place * place);
  }

  Layers layers_of(std::span<const Individual> pool) const {
    int now = 0;
    for (const Individual& individual : pool) now = std::max(now, individual.generation);
    Layers layers(layer_count());
    for (const std::size_t i : best_first(pool)) {
      std::size_t layer = 0;
      while (now - pool[i].line_began >= age_limit(layer)) ++layer;
      while (layer < layers.size() && layers[layer].size() == capacity(layer)) ++layer;
      if (layer < layers.size()) layers[layer].push_back(i);
    }
    return layers;
  }

  const AlgorithmSettings settings_;
};

}  // namespace

AlgorithmDescription alps() {
  return {.name = "alps",
          .help =
              "age-layered population structure: robots compete with others of their age; new random robots "
              "come all the time",
          .make = [](const AlgorithmSettings& settings) -> std::unique_ptr<Algorithm> {
            return std::make_unique<AgeLayers>(settings);
          }};
}

}  // namespace mercury
