// SPDX-License-Identifier: Apache-2.0
#include "app/commands/best_of.h"

#include <algorithm>

#include "app/base/progress.h"
#include "app/commands/evaluation_results.h"
#include "mercury/evaluator.h"

namespace mercury {
namespace {

double distance_of(const Winner& winner) { return winner.result.distance; }

// Keeps the best `count`, the best first. Candidates come in the order of their indices, and equal ones stay in it.
void keep_best(std::vector<Winner>& winners, Winner candidate, std::uint64_t count) {
  const auto place = std::ranges::upper_bound(winners, distance_of(candidate), std::greater(), distance_of);
  winners.insert(place, std::move(candidate));
  if (winners.size() > count) winners.pop_back();
}

}  // namespace

std::uint64_t ContestResult::tried() const {
  std::uint64_t sum = 0;
  for (const auto& [fate, number] : fates)
    if (fate != Fate::stopped) sum += number;
  return sum;
}

ContestResult best_of(const Contest& contest, const MakeRobot& make, std::uint64_t count, UnsavedResults& results) {
  const EvaluationRequest request = trial_request(contest.trials, contest.configuration, contest.seed);
  const RandomRobots robots{.kind = contest.kind, .count = contest.candidates, .seed = contest.seed};
  const RobotSource source = [&](std::size_t index) {
    return std::make_shared<const Robot>(make(contest.seed, index));
  };
  const auto per_robot = static_cast<std::size_t>(contest.trials.trials);
  Evaluator evaluator(request, trial_source(source, contest.trials, contest.seed), contest.candidates * per_robot);
  Progress progress("searching", per_robot > 1 ? "trials" : "robots",
                    static_cast<std::int64_t>(contest.candidates * per_robot));
  ContestResult found;
  std::vector<Evaluation> of_robot;
  found.interrupted =
      !take_results(evaluator, progress, request.settling + request.steps, results, [&](const Evaluation& trial) {
        const std::size_t index = trial.index / per_robot;
        if (!of_robot.empty() && of_robot.front().index / per_robot != index) of_robot.clear();
        of_robot.push_back(trial);
        if (of_robot.size() < per_robot) return;
        RobotResult result = result_of(identity_of(robots, index, index), of_robot, request, contest.trials);
        of_robot.clear();
        ++found.fates[result.fate];
        if (contest.watch) contest.watch(result);
        if (result.fate == Fate::sound && std::isfinite(result.distance))
          keep_best(found.winners, {trial.robot, std::move(result)}, count);
      });
  return found;
}

}  // namespace mercury
