// SPDX-License-Identifier: Apache-2.0
#include <charconv>
#include <cmath>
#include <string>

#include "mercury/error.h"
#include "mercury/evolution.h"

namespace mercury {
namespace {

void require(bool holds, const char* parameter, const std::string& problem) {
  if (!holds) throw ParameterError(parameter, problem);
}

std::string number(double value) {
  char text[32];
  return {text, std::to_chars(text, text + sizeof text, value).ptr};
}

void require_share(double value, const char* parameter) {
  require(value >= 0 && value < 1, parameter, std::to_string(value) + " is not accepted; give at least 0 and below 1");
}

}  // namespace

void validate(const TrialSettings& trials) {
  require(std::isfinite(trials.seconds) && trials.seconds >= 0, "seconds", "give a finite number >= 0 s");
  require(trials.settle == 0 || (trials.settle > 0 && trials.settle < trials.seconds), "settle",
          number(trials.settle) + " is not accepted; give 0 s or more, and less than the " + number(trials.seconds) +
              " s of --seconds");
  require(trials.trials >= 1 && trials.trials <= 1000, "trials", "give 1 to 1000");
  require(std::isfinite(trials.noise) && trials.noise >= 0, "noise", "give a finite number >= 0");
  require_share(trials.damage, "damage");
  require(trials.strain_limit > 0, "strain_limit", number(trials.strain_limit) + " is not accepted; give a number > 0");
}

void validate(const EvolutionSettings& settings) {
  make_algorithm(settings.algorithm);
  validate(settings.configuration);
  const TrialSettings& trials = settings.trials;
  validate(trials);
  require(trials.seconds > 0, "seconds", "give a finite number > 0 s");
  require(settings.generations >= 0, "generations", "give 0 or more");
  require(std::isfinite(settings.mutation) && settings.mutation > 0, "mutation", "give a finite number > 0");
  require(!settings.objectives.empty(), "objective", "give at least one formula");
  for (const std::string& formula : settings.objectives) Objective{formula};
  for (const AlgorithmDescription& algorithm : algorithms())
    require(algorithm.name != settings.algorithm.name || algorithm.many_objectives || settings.objectives.size() == 1,
            "algorithm", std::string(algorithm.name) + " takes one objective; with several, give nsga2");
  require(!trials.racing || (trials.trials == 1 && settings.objectives.size() == 1), "racing",
          "works with one objective and one trial per robot");
}

std::unique_ptr<Assessor> make_assessor(const EvolutionSettings& settings) {
  std::vector<Objective> objectives;
  for (const std::string& formula : settings.objectives) objectives.emplace_back(formula);
  return make_local_assessor(settings.configuration, settings.trials, std::move(objectives), settings.seed);
}

}  // namespace mercury
