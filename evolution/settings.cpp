// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <set>
#include <span>
#include <string>
#include <string_view>

#include "evolution/selection/registry.h"
#include "mercury/custom.h"
#include "mercury/error.h"
#include "mercury/evolution.h"
#include "mercury/names.h"
#include "mercury/number_text.h"
#include "mercury/quantity.h"

namespace mercury {
namespace {

constexpr int most_cells = 1'000'000;  // of a map

void require(bool holds, const char* parameter, const std::string& problem) {
  if (!holds) throw ParameterError(parameter, problem);
}

void validate_axes(std::span<const MapAxis> axes) {
  double cells = 1;
  std::set<std::string_view> names;
  for (const MapAxis& axis : axes) {
    require(find_quantity(axis.quantity).has_value(), "axes",
            "there is no quantity \"" + axis.quantity + "\"; give one of " + list_of(names_of_quantities()));
    require(names.insert(axis.quantity).second, "axes", axis.quantity + " is given twice");
    require(std::isfinite(axis.lowest) && std::isfinite(axis.highest) && std::isfinite(axis.highest - axis.lowest) &&
                axis.lowest < axis.highest,
            "axes", axis.quantity + " needs two finite ends, the lower one first");
    require(axis.cells >= 1, "axes", axis.quantity + " needs at least one cell");
    cells *= axis.cells;
  }
  require(cells <= most_cells, "axes", "the map has more than " + std::to_string(most_cells) + " cells");
}

void validate_islands(const AlgorithmSettings& settings) {
  if (settings.islands == 1) return;
  const AlgorithmDescription& algorithm = algorithm_named(settings.name);
  require(!algorithm.learns && !algorithm.has_map, "islands",
          settings.name + (algorithm.has_map ? " keeps one map" : " learns from all robots") +
              "; give 1, or --algorithm ga, afpo, alps, nsga2, neat or random");
  require(settings.islands <= settings.population, "islands",
          std::to_string(settings.islands) + " are more than the population of " + std::to_string(settings.population));
  const std::size_t smallest = settings.population / settings.islands;
  require(settings.migration_interval == 0 || settings.migrants < smallest, "migrants",
          std::to_string(settings.migrants) + " leave no other robot on an island of " + std::to_string(smallest) +
              "; give fewer, or a larger population");
}

}  // namespace

void validate(const AlgorithmSettings& settings) {
  check_parameters(settings);
  validate_axes(settings.axes);
  require(!algorithm_named(settings.name).of_behavior || !settings.axes.empty(), "axes",
          settings.name + " needs one or more quantities, such as size and muscle_share");
  validate_islands(settings);
}

void validate(const TrialSettings& trials) {
  require(trials.settle == 0 || (trials.settle > 0 && trials.settle < trials.seconds), "settle",
          shortest_text(trials.settle) + " is not accepted; give 0 s or more, and less than the " +
              shortest_text(trials.seconds) + " s of --seconds");
  check_parameters(trials);
}

void validate(const EvolutionSettings& settings) {
  make_algorithm(settings.algorithm);
  validate(settings.configuration);
  const TrialSettings& trials = settings.trials;
  validate(trials);
  require(trials.seconds > 0, "seconds", "give a finite number > 0 s");
  check_parameters(settings);
  require(!settings.objectives.empty(), "objective", "give at least one formula");
  for (const std::string& formula : settings.objectives) Objective{formula};
  for (const AlgorithmDescription& algorithm : algorithms())
    require(algorithm.name != settings.algorithm.name || algorithm.many_objectives || settings.objectives.size() == 1,
            "algorithm", std::string(algorithm.name) + " takes one objective; with several, give nsga2");
  require(settings.children == 0 || !algorithm_named(settings.algorithm.name).of_numbers, "children",
          settings.algorithm.name + " makes as many as its population; give that alone");
  const AlgorithmSettings& algorithm = settings.algorithm;
  require(settings.children == 0 || algorithm.islands == 1 ||
              settings.children / algorithm.islands > (algorithm.migration_interval > 0 ? algorithm.migrants : 0),
          "children",
          std::to_string(settings.children) + " are too few for " + std::to_string(algorithm.islands) +
              " islands and their migrants");
  require(!settings.pipelined || !algorithm_named(settings.algorithm.name).learns, "pipelined",
          settings.algorithm.name + " learns from each generation before it makes the next; leave it out");
  require(!trials.racing || !is_custom(settings.objectives.front()), "racing",
          "compares robots during their trials, and " + settings.objectives.front() + " is known after them");
  require(!trials.racing || (trials.trials == 1 && settings.objectives.size() == 1), "racing",
          "works with one objective and one trial per robot");
}

std::unique_ptr<Assessor> make_assessor(const EvolutionSettings& settings) {
  std::vector<Objective> objectives;
  for (const std::string& formula : settings.objectives) objectives.emplace_back(formula);
  TrialSettings trials = settings.trials;
  for (const MapAxis& axis : settings.algorithm.axes)
    if (const auto quantity = find_quantity(axis.quantity)) {
      trials.folding = trials.folding || quantities()[*quantity].of_folding;
      trials.upright = trials.upright || quantities()[*quantity].of_upright;
    }
  return make_local_assessor(settings.configuration, trials, std::move(objectives), settings.seed);
}

}  // namespace mercury
