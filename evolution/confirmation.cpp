// SPDX-License-Identifier: Apache-2.0
#include "mercury/confirmation.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <memory>
#include <utility>

#include "mercury/number_text.h"
#include "mercury/quantity.h"

namespace mercury {
namespace {

constexpr std::string_view names[] = {"failed", "not sound", "chaotic", "depends on dt", "transient", "confirmed"};

std::string percent(double share) { return fixed_text(100 * share, share < 0.1 ? 1 : 0) + " %"; }
std::string at(const CheckedStep& step) {
  char text[40];
  std::snprintf(text, sizeof text, "at dt %g s", step.dt);
  return text;
}

bool is_sound(const CheckedStep& step) { return step.fate == Fate::sound; }
std::string fate_text(const CheckedStep& step) {
  return (step.fate == Fate::undefined ? "the objective is not a finite number" : std::string(name_of(step.fate))) +
         " " + at(step);
}

// Empty = it is not chaotic.
std::string chaos(const Confirmation& checked, double same) {
  for (const CheckedStep& step : checked.steps) {
    if (!is_sound(step)) continue;
    const double between = step.score.between_quartiles(), median = std::abs(step.score.median);
    if (between <= std::max(most_between_quartiles * median, same)) continue;
    return "the quartiles " + at(step) + ", " + fixed_text(step.score.lower_quartile, 4) + " and " +
           fixed_text(step.score.upper_quartile, 4) + ", are " +
           (median > 0 ? percent(between / median) + " of the median apart" : "apart");
  }
  return "";
}

// Empty = it does not depend on dt.
std::string dependence(const Confirmation& checked, double same, const std::string& what) {
  for (const CheckedStep& step : checked.steps)
    if (!is_sound(step)) return fate_text(step);
  const CheckedStep &coarse = checked.steps.front(), &fine = checked.steps.back();
  const double change = std::abs(coarse.score.median - fine.score.median), scale = std::abs(fine.score.median);
  const double accepted =
      std::max({most_change_with_dt * scale, same, coarse.score.between_quartiles(), fine.score.between_quartiles()});
  if (change <= accepted) return "";
  return "the " + what + " is " + fixed_text(coarse.score.median, 4) + " " + at(coarse) + " and " +
         fixed_text(fine.score.median, 4) + " " + at(fine);
}

// The trials of one robot at one time step.
CheckedStep checked_step(std::span<const Evaluation> trials, const EvaluationRequest& request,
                         const TrialSettings& settings, const Objective& objective) {
  static const std::size_t steady = find_quantity("steady").value();
  CheckedStep step{.dt = request.configuration.dt, .fate = Fate::sound};
  std::vector<double> scores;
  double steady_trials = 0;
  for (const Evaluation& trial : trials) {
    const Fate fate = fate_of(trial, request, settings);
    step.fate = worse(step.fate, fate);
    if (!trial.failure.empty()) continue;
    const std::vector<double> values =
        quantities_of({.robot = *trial.robot, .evaluation = trial, .configuration = request.configuration});
    scores.push_back(objective.score(values));
    if (fate == Fate::sound && scores.back() == worst_score) step.fate = worse(step.fate, Fate::undefined);
    steady_trials += values[steady];
  }
  if (!is_sound(step)) return step;
  step.score = settings.mean ? mean_and_error(scores) : spread_of(std::move(scores));
  step.steady_share = steady_trials / static_cast<double>(trials.size());
  return step;
}

}  // namespace

std::string_view name_of(Verdict verdict) { return names[static_cast<std::size_t>(verdict)]; }

std::optional<Verdict> verdict_named(std::string_view name) {
  const auto* found = std::ranges::find(names, name);
  if (found == std::end(names)) return std::nullopt;
  return static_cast<Verdict>(found - std::begin(names));
}

void judge(Confirmation& checked, double same, bool travels, bool of_means) {
  const auto decide = [&](Verdict verdict, std::string reason) {
    checked.verdict = verdict;
    checked.reason = std::move(reason);
  };
  const CheckedStep& first = checked.steps.front();
  if (first.fate == Fate::failed) return decide(Verdict::failed, std::move(checked.reason));
  if (!is_sound(first)) return decide(Verdict::unsound, fate_text(first));
  if (std::string reason = of_means ? "" : chaos(checked, same); !reason.empty())
    return decide(Verdict::chaotic, std::move(reason));
  if (std::string reason = dependence(checked, same, of_means ? "mean" : "median"); !reason.empty())
    return decide(Verdict::depends_on_dt, std::move(reason));
  if (travels && first.steady_share < 0.5)
    return decide(Verdict::transient, "the speeds in the second and the last third differ by more than 20 % in " +
                                          percent(1 - first.steady_share) + " of the trials");
  decide(Verdict::confirmed, "");
}

std::optional<std::vector<Confirmation>> check_robots(
    const RobotSource& robots, std::size_t count, const Configuration& configuration, const TrialSettings& trials,
    const Objective& objective, std::uint64_t seed, const std::function<bool(std::size_t done, std::size_t all)>& watch,
    std::string* device_name) {
  constexpr std::chrono::milliseconds watch_period(100);
  const auto per_step = static_cast<std::size_t>(trials.trials);
  // Few robots do not keep a device busy, so all time steps are tried at once. Many would take too much memory so.
  constexpr std::size_t few = 256;
  const bool at_once = count * per_step <= few;
  std::vector<EvaluationRequest> requests;
  std::vector<std::unique_ptr<Evaluator>> evaluators(checked_steps);
  const auto start = [&](std::size_t k) {
    evaluators[k] = std::make_unique<Evaluator>(requests[k], trial_source(robots, trials, seed), count * per_step);
  };
  std::size_t all = 0, finished = 0;
  for (std::size_t k = 0; k < checked_steps; ++k) {
    Configuration finer = configuration;
    finer.dt = configuration.dt / static_cast<double>(1 << k);
    EvaluationRequest& request = requests.emplace_back(trial_request(trials, finer, seed));
    if (uses_folding(objective)) request.folding = measure_all_folding;
    request.upright = request.upright || uses_upright(objective);
    request.notes = false;
    if (at_once) start(k);
    all += count * per_step << k;
  }
  // Smaller steps take longer; trials count by their steps.
  const auto done = [&] {
    std::size_t sum = finished;
    for (std::size_t k = 0; k < checked_steps; ++k)
      if (evaluators[k]) sum += evaluators[k]->progress().done << k;
    return sum;
  };
  std::vector<Confirmation> checked(count);
  std::vector<double> lengths(count);
  for (std::size_t k = 0; k < checked_steps; ++k) {
    const EvaluationRequest& request = requests[k];
    if (!at_once) start(k);
    Evaluator& evaluator = *evaluators[k];
    for (std::size_t i = 0; i < count; ++i) {
      std::vector<Evaluation> of_robot;
      while (of_robot.size() < per_step) {
        while (!evaluator.wait_for(watch_period))
          if (watch && !watch(done(), all)) return std::nullopt;
        of_robot.push_back(evaluator.next().value());
      }
      checked[i].steps[k] = checked_step(of_robot, request, trials, objective);
      if (!of_robot.front().failure.empty()) checked[i].reason = of_robot.front().failure;
      if (!of_robot.front().robot) continue;
      checked[i].robot = of_robot.front().robot->name;
      lengths[i] = quantities()[find_quantity("length").value()].value(
          {*of_robot.front().robot, of_robot.front(), request.configuration});
    }
    if (watch && !watch(done(), all)) return std::nullopt;
    if (device_name) *device_name = evaluator.device_name();
    evaluators[k].reset();
    finished += count * per_step << k;
  }
  constexpr std::string_view distances[] = {"distance", "-target_distance", "target_approach", "-target_nearest"};
  const bool is_distance = std::ranges::find(distances, objective.formula()) != std::end(distances);
  const bool travels = std::ranges::any_of(objective.uses(), [](std::size_t q) { return quantities()[q].of_travel; });
  for (std::size_t i = 0; i < count; ++i)
    judge(checked[i], is_distance ? same_place * lengths[i] : 0, travels, trials.mean);
  return checked;
}

}  // namespace mercury
