// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cmath>

#include "evolution/selection/ranking.h"
#include "evolution/selection/registry.h"
#include "mercury/error.h"
#include "mercury/quantity.h"

namespace mercury {
namespace {

constexpr int most_cells = 1'000'000;  // of a map

void require(bool holds, const char* parameter, const std::string& problem) {
  if (!holds) throw ParameterError(parameter, problem);
}

std::string names_of_quantities() {
  std::string names;
  for (const Quantity& quantity : quantities()) names += (names.empty() ? "" : ", ") + std::string(quantity.name);
  return names;
}

void validate_axes(std::span<const MapAxis> axes) {
  double cells = 1;
  for (const MapAxis& axis : axes) {
    require(find_quantity(axis.quantity).has_value(), "axes",
            "there is no quantity \"" + axis.quantity + "\"; give one of " + names_of_quantities());
    require(std::isfinite(axis.lowest) && std::isfinite(axis.highest) && std::isfinite(axis.highest - axis.lowest) &&
                axis.lowest < axis.highest,
            "axes", axis.quantity + " needs two finite ends, the lower one first");
    require(axis.cells >= 1, "axes", axis.quantity + " needs at least one cell");
    cells *= axis.cells;
  }
  require(cells <= most_cells, "axes", "the map has more than " + std::to_string(most_cells) + " cells");
}

void validate(const AlgorithmSettings& settings) {
  check_parameters(settings);
  validate_axes(settings.axes);
  require(settings.name != "map-elites" || !settings.axes.empty(), "axes",
          "map-elites needs one or more quantities, such as size and muscle_share");
}

}  // namespace

std::span<const AlgorithmDescription> algorithms() {
  static const std::array all{ga(), afpo(), nsga2(), map_elites(), random_search()};
  return all;
}

std::unique_ptr<Algorithm> make_algorithm(const AlgorithmSettings& settings) {
  std::string names;
  for (const AlgorithmDescription& algorithm : algorithms()) {
    if (algorithm.name == settings.name) {
      validate(settings);
      return algorithm.make(settings);
    }
    names += (names.empty() ? "" : ", ") + std::string(algorithm.name);
  }
  throw ParameterError("algorithm", "\"" + settings.name + "\" is not an algorithm; give one of " + names);
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
