// SPDX-License-Identifier: Apache-2.0
#include "app/commands/best_of.h"

#include <algorithm>
#include <cmath>
#include <variant>

#include "app/base/interrupt.h"
#include "app/base/progress.h"
#include "app/base/stepping.h"
#include "mercury/simulation.h"

namespace mercury {
namespace {

constexpr std::uint64_t at_once = 512;  // robots per simulation

double distance_between(const Telemetry& start, const Telemetry& end, bool on_land) {
  Vec3 path = end.center_of_mass - start.center_of_mass;
  if (on_land) path.z = 0;
  return length(path);
}

// Adds the robots of a round to the winners and keeps the best.
void keep_best(std::vector<Winner>& winners, std::vector<Winner> more, std::uint64_t count) {
  winners.insert(winners.end(), std::make_move_iterator(more.begin()), std::make_move_iterator(more.end()));
  std::stable_sort(winners.begin(), winners.end(),
                   [](const Winner& a, const Winner& b) { return a.distance > b.distance; });
  if (winners.size() > count) winners.erase(winners.begin() + static_cast<std::ptrdiff_t>(count), winners.end());
}

// Simulates a batch of robots. Returns nothing if the user interrupts.
std::vector<Winner> try_robots(const Contest& contest, std::vector<Robot> robots) {
  Simulation simulation(contest.configuration, robots);
  Stepper stepper(simulation);
  if (!stepper.advance_to(contest.settling)) return {};
  const std::vector<Telemetry> start = simulation.telemetry();
  if (!stepper.advance_to(contest.steps)) return {};
  const std::vector<Telemetry> end = simulation.telemetry();
  const bool on_land = std::holds_alternative<Land>(contest.configuration.environment);
  std::vector<Winner> finished;
  for (std::size_t i = 0; i < robots.size(); ++i) {
    const double distance = distance_between(start[i], end[i], on_land);
    if (!end[i].exploded && std::isfinite(distance)) finished.push_back({std::move(robots[i]), distance});
  }
  return finished;
}

}  // namespace

std::vector<Winner> best_of(const Contest& contest, const MakeRobot& make, std::uint64_t seed, std::uint64_t count) {
  std::vector<Winner> winners;
  Progress progress("searching", "robots", static_cast<std::int64_t>(contest.candidates));
  for (std::uint64_t first = 0; first < contest.candidates && !interrupted(); first += at_once) {
    const auto batch_size = static_cast<std::size_t>(std::min(at_once, contest.candidates - first));
    std::vector<Robot> robots;
    for (MadeRobot& made : make_robots(make, seed, first, batch_size))
      if (made.robot) robots.push_back(std::move(*made.robot));
    keep_best(winners, try_robots(contest, std::move(robots)), count);
    progress.update(static_cast<std::int64_t>(first + batch_size));
  }
  return winners;
}

}  // namespace mercury
