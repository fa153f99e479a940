// SPDX-License-Identifier: Apache-2.0
#include "app/commands/best_of.h"

#include <algorithm>
#include <cmath>
#include <variant>

#include "app/base/progress.h"
#include "app/commands/evaluation_results.h"
#include "mercury/evaluator.h"

namespace mercury {
namespace {

double distance_between(const Telemetry& start, const Telemetry& end, bool on_land) {
  Vec3 path = end.center_of_mass - start.center_of_mass;
  if (on_land) path.z = 0;
  return length(path);
}

// Keeps the best `count`, the best first. Candidates come in the order of their indices, and equal ones stay in it.
void keep_best(std::vector<Winner>& winners, Winner candidate, std::uint64_t count) {
  const auto place = std::ranges::upper_bound(winners, candidate.distance, std::greater(), &Winner::distance);
  winners.insert(place, std::move(candidate));
  if (winners.size() > count) winners.pop_back();
}

}  // namespace

std::vector<Winner> best_of(const Contest& contest, const MakeRobot& make, std::uint64_t seed, std::uint64_t count) {
  const bool on_land = std::holds_alternative<Land>(contest.configuration.environment);
  const RobotSource source = [&](std::size_t index) { return std::make_shared<const Robot>(make(seed, index)); };
  Evaluator evaluator(
      {.configuration = contest.configuration, .settling = contest.settling, .steps = contest.steps - contest.settling},
      source, contest.candidates);
  Progress progress("searching", "robots", static_cast<std::int64_t>(contest.candidates));
  std::vector<Winner> winners;
  take_results(evaluator, progress, contest.steps, [&](const Evaluation& robot) {
    const double distance = distance_between(robot.start, robot.end, on_land);
    if (robot.failure.empty() && !robot.end.exploded && std::isfinite(distance))
      keep_best(winners, {robot.robot, distance}, count);
  });
  return winners;
}

}  // namespace mercury
