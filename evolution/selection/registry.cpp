// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cmath>

#include "evolution/selection/ranking.h"
#include "evolution/selection/registry.h"
#include "mercury/custom.h"
#include "mercury/error.h"
#include "mercury/names.h"
#include "mercury/quantity.h"

namespace mercury {

std::span<const AlgorithmDescription> algorithms() {
  static const std::array all{ga(),   afpo(),   alps(),       nsga2(),  map_elites(),   novelty_search(),
                              neat(), cma_es(), sep_cma_es(), cma_me(), random_search()};
  return all;
}

const AlgorithmDescription& algorithm_named(std::string_view name) {
  static const AlgorithmDescription custom = custom_algorithm();
  if (is_custom(name)) {
    check_custom_name("algorithm", name);
    return custom;
  }
  std::vector<std::string> names;
  for (const AlgorithmDescription& algorithm : algorithms()) {
    if (algorithm.name == name) return algorithm;
    names.emplace_back(algorithm.name);
  }
  throw ParameterError("algorithm", "\"" + std::string(name) + "\" is not an algorithm; give one of " + list_of(names));
}

const AlgorithmDescription& algorithm_of(const AlgorithmSettings& settings) {
  static const AlgorithmDescription map = custom_map();
  const AlgorithmDescription& named = algorithm_named(settings.name);
  return is_custom(settings.name) && !settings.axes.empty() ? map : named;
}

std::optional<MapAxis> usual_axis(std::string_view name) {
  const auto quantity = find_quantity(name);
  if (!quantity) return std::nullopt;
  const Quantity& found = quantities()[*quantity];
  return MapAxis{.quantity = std::string(found.name), .lowest = found.usual_lowest, .highest = found.usual_highest};
}

void complete_algorithm(AlgorithmSettings& settings, bool is_named, std::size_t objectives) {
  if (!is_named) settings.name = !settings.axes.empty() ? "map-elites" : objectives > 1 ? "nsga2" : "afpo";
  if (algorithm_of(settings).of_behavior && settings.axes.empty())
    settings.axes = {*usual_axis("masses"), *usual_axis("muscle_share")};
}

std::unique_ptr<Algorithm> make_algorithm(const AlgorithmSettings& settings) {
  const AlgorithmDescription& algorithm = algorithm_named(settings.name);
  validate(settings);
  return algorithm.make(settings);
}

// Random search, the baseline: every robot is new, the best ones live on.
namespace {

class RandomSearch : public Algorithm {
 public:
  explicit RandomSearch(const AlgorithmSettings& settings) : settings_(settings) {}

  std::vector<ChildPlan> plan(std::span<const Individual>, std::size_t children, Random&) const override {
    return std::vector<ChildPlan>(children);
  }

  std::vector<std::size_t> survivors(std::span<const Individual> pool, std::size_t) const override {
    std::vector<std::size_t> order = best_first(pool);
    order.resize(std::min(order.size(), settings_.population));
    return order;
  }

 private:
  const AlgorithmSettings settings_;
};

}  // namespace

AlgorithmDescription random_search() {
  return {.name = "random",
          .help = "random search, the baseline: every robot is new",
          .make = [](const AlgorithmSettings& settings) -> std::unique_ptr<Algorithm> {
            return std::make_unique<RandomSearch>(settings);
          }};
}

}  // namespace mercury
