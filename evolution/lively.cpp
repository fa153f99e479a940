// SPDX-License-Identifier: Apache-2.0
#include "mercury/lively.h"

#include <algorithm>
#include <chrono>
#include <memory>
#include <utility>

#include "mercury/distance.h"
#include "mercury/evaluator.h"
#include "mercury/objective.h"
#include "mercury/real_body.h"
#include "mercury/trials.h"

namespace mercury {
namespace {

constexpr double quick_seconds = 4;  // of a trial

}  // namespace

Configuration lively_configuration(const RandomRobots& request, const std::string& environment) {
  const Physics physics = real_material_in(request.values) ? Physics::real : Physics::paper;
  const bool can_move =
      !environment.empty() && why_meaningless(Objective("distance"), environment_named(environment)).empty();
  const std::string own = physics == Physics::real ? "" : generator_named(request.kind).environment;
  Configuration configuration = default_configuration(physics, can_move ? environment : own);
  configuration.device = {.kind = DeviceKind::cpu};
  return configuration;
}

std::vector<std::uint64_t> liveliest(const RandomRobots& request, const Configuration& configuration,
                                     const Watch& watch) {
  constexpr std::chrono::milliseconds watch_period(50);
  const Generator& generator = generator_named(request.kind);
  generator.validate(request.values);
  TrialSettings trials = one_trial();
  trials.seconds = quick_seconds;
  trials.jitter = usual_jitter;
  const EvaluationRequest trial = trial_request(trials, configuration, request.seed);
  const auto count = static_cast<std::size_t>(request.count), all = count * tried_per_lively;
  const RobotSource robots = [&](std::size_t i) {
    return std::make_shared<const Robot>(
        generator.make(request.values, request.environment, request.seed, request.first + i));
  };
  struct Tried {
    std::uint64_t index = 0;
    int rank = 0;  // 0 = sound, 1 = not, 2 = it cannot be made
    double distance = 0;
  };
  std::vector<Tried> tried;
  Evaluator evaluator(trial, robots, all);
  while (tried.size() < all) {
    while (!evaluator.wait_for(watch_period))
      if (watch && !watch(evaluator.progress().done, all)) return {};
    const Evaluation robot = evaluator.next().value();
    Tried& one = tried.emplace_back(Tried{.index = request.first + robot.index});
    const Fate fate = fate_of(robot, trial, trials);
    one.rank = fate == Fate::sound ? 0 : fate == Fate::failed ? 2 : 1;
    if (one.rank == 0)
      one.distance = distance_between(robot.start.center_of_mass, robot.end.center_of_mass, configuration.environment);
  }
  std::ranges::stable_sort(tried, [](const Tried& a, const Tried& b) {
    return a.rank != b.rank ? a.rank < b.rank : a.distance > b.distance;
  });
  std::vector<std::uint64_t> indices;
  for (std::size_t i = 0; i < count; ++i) indices.push_back(tried[i].index);
  return indices;
}

std::vector<RandomRobots> lively_requests(const RandomRobots& request, const Configuration& configuration,
                                          const Watch& watch) {
  std::vector<RandomRobots> requests;
  for (const std::uint64_t index : liveliest(request, configuration, watch)) {
    RandomRobots& one = requests.emplace_back(request);
    one.count = 1;
    one.first = index;
  }
  return requests;
}

}  // namespace mercury
