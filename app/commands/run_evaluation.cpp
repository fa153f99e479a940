// SPDX-License-Identifier: Apache-2.0
#include "app/commands/run_evaluation.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "app/base/messages.h"
#include "app/base/progress.h"
#include "app/commands/evaluation_results.h"
#include "mercury/clock.h"
#include "mercury/error.h"
#include "mercury/evaluator.h"

namespace mercury {
namespace {

RobotResult result_of(const Evaluation& robot, double seconds) {
  return {.name = robot.robot->name,
          .masses = robot.robot->masses.size(),
          .springs = robot.robot->springs.size(),
          .displacement = length(robot.end.center_of_mass - robot.start.center_of_mass),
          .mean_speed = seconds > 0 ? robot.path / seconds : 0,
          .largest_strain = robot.largest_strain,
          .strained_share = robot.strained_share,
          .exploded = robot.end.exploded,
          .exploded_at = robot.end.exploded_at,
          .culprit_spring = robot.end.culprit_spring,
          .hash = robot.hash};
}

// Robots that could not be made, request by request.
class Failures {
 public:
  explicit Failures(const RobotSequence& robots) : robots_(robots), failed_(robots.random.size()) {}

  void add(const Evaluation& robot) {
    std::size_t first = robots_.count;
    for (std::size_t i = robots_.random.size(); i-- > 0;) {
      first -= robots_.random[i].count;
      if (robot.index < first) continue;
      failed_[i].push_back({robots_.random[i].first + (robot.index - first), robot.failure});
      return;
    }
    throw InputError(robot.robot ? robot.robot->name : "robot " + std::to_string(robot.index), robot.failure);
  }

  void report() const {
    for (std::size_t i = 0; i < failed_.size(); ++i) {
      const RandomRobots& request = robots_.random[i];
      if (failed_[i].size() == request.count)
        throw InputError("--random", "none could be grown: " + failed_[i].front().reason);
      for (const FailedRobot& robot : failed_[i])
        warn(fmt::format("{}-{}-{} was left out: {}", request.kind, request.seed, robot.index, robot.reason));
    }
  }

 private:
  const RobotSequence& robots_;
  std::vector<std::vector<FailedRobot>> failed_;  // per request
};

}  // namespace

RunReport evaluate(const RobotSequence& robots, const Configuration& configuration, std::int64_t steps) {
  const std::int64_t period = std::max<std::int64_t>(1, std::llround(sample_period / configuration.dt));
  Evaluator evaluator({.configuration = configuration, .steps = steps, .sample_every = period, .hashes = true},
                      robots.source, robots.count);
  RunReport report{.configuration = configuration, .device = {}, .steps = steps};
  Failures failures(robots);
  std::size_t failed = 0;
  bool stopped = false;
  {
    Progress progress("simulating", "robots", static_cast<std::int64_t>(robots.count));
    stopped = !take_results(evaluator, progress, steps, [&](const Evaluation& robot) {
      if (!robot.failure.empty()) {
        ++failed;
        return failures.add(robot);
      }
      if (report.robots.empty()) report.steps = robot.steps;
      if (robot.steps == report.steps)
        report.robots.push_back(result_of(robot, time_of({.dt = configuration.dt, .step = robot.steps})));
    });
  }
  report.missing = robots.count - failed - report.robots.size();
  if (stopped && report.robots.empty()) report.steps = 0;
  report.interrupted = stopped && (report.missing > 0 || report.steps < steps);
  if (!report.interrupted) failures.report();
  report.seconds = time_of({.dt = configuration.dt, .step = report.steps});
  report.device = evaluator.device_name();
  report.notes = evaluator.notes();
  report.wall_seconds = evaluator.progress().stepping;
  return report;
}

}  // namespace mercury
