// SPDX-License-Identifier: Apache-2.0
// Custom algorithms (mercury/custom.h): the program makes the children, or says whose they are. Unless it says who
// lives on, these are the best so far; of several objectives, the best fronts; of a map, the best of each cell.
#include "mercury/custom.h"

#include <algorithm>

#include "evolution/selection/registry.h"
#include "mercury/error.h"

namespace mercury {
namespace {

constexpr std::size_t longest_name = 100;

bool belongs_into_name(char c) {
  return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '.' || c == '_' || c == '-';
}

class CustomAlgorithm : public Algorithm {
 public:
  explicit CustomAlgorithm(const AlgorithmSettings& settings) : settings_(settings) {}

  std::vector<ChildPlan> plan(std::span<const Individual>, std::size_t, Random&) const override {
    throw InputError("algorithm", settings_.name + " is a program, which makes the children itself");
  }
  std::vector<std::size_t> survivors(std::span<const Individual> pool, std::size_t living) const override {
    const bool has_objectives =
        std::ranges::any_of(pool, [](const Individual& individual) { return individual.assessment.scores.size() > 1; });
    AlgorithmSettings usual = settings_;
    usual.name = !usual.axes.empty() ? "map-elites" : has_objectives ? "nsga2" : "random";
    return make_algorithm(usual)->survivors(pool, living);
  }

 private:
  const AlgorithmSettings settings_;
};

std::unique_ptr<Algorithm> make_custom(const AlgorithmSettings& settings) {
  return std::make_unique<CustomAlgorithm>(settings);
}

}  // namespace

void check_custom_name(const std::string& parameter, std::string_view name) {
  const std::string_view own = is_custom(name) ? name.substr(custom_prefix.size()) : std::string_view();
  if (own.empty() || own.size() > longest_name || !std::ranges::all_of(own, belongs_into_name))
    throw ParameterError(parameter, "\"" + std::string(name.substr(0, longest_name)) + "\" is not accepted; give " +
                                        std::string(custom_prefix) + "NAME of letters, digits and . _ -");
}

std::string custom_parts(const EvolutionSettings& settings, const GenomeSpaceRequest& space) {
  std::vector<std::string> parts;
  if (is_custom(settings.algorithm.name)) parts.push_back("the algorithm " + settings.algorithm.name);
  for (const std::string& objective : settings.objectives)
    if (is_custom(objective)) parts.push_back("the objective " + objective);
  if (space.founders.empty() && is_custom(space.kind)) parts.push_back("the genomes " + space.kind);
  std::string text;
  for (std::size_t i = 0; i < parts.size(); ++i)
    text.append(i == 0 ? "" : i + 1 < parts.size() ? ", " : " and ").append(parts[i]);
  return text;
}

// It may learn, and is asked for one objective as for several.
AlgorithmDescription custom_algorithm() {
  return {.name = custom_prefix, .help = "a program", .many_objectives = true, .learns = true, .make = make_custom};
}

AlgorithmDescription custom_map() {
  AlgorithmDescription description = custom_algorithm();
  description.of_behavior = description.has_map = true;
  return description;
}

}  // namespace mercury
