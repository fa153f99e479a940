// SPDX-License-Identifier: Apache-2.0
// The search of `mercury new --best-of`.
#include "app/commands/best_of.h"

#include <gtest/gtest.h>

#include <cmath>

#include "app/commands/run_evaluation.h"
#include "mercury/error.h"
#include "mercury/random_voxel.h"
#include "mercury/simulation.h"
#include "tests/sim/backend.h"

namespace mercury {
namespace {

Robot make(std::uint64_t seed, std::uint64_t index) {
  if (index == 1) throw InputError("cloud", "none");
  return random_voxel_robot({.smallest = {3, 2, 2}, .largest = {3, 2, 2}}, seed, index);
}

Contest contest_of(std::uint64_t candidates, double seconds, const Configuration& configuration = {}) {
  return {.kind = "voxel",
          .seed = 3,
          .candidates = candidates,
          .configuration = configuration,
          .trials = {.seconds = seconds}};
}

class BestOf : public BackendTest {
 protected:
  UnsavedResults results;
};

TEST_P(BestOf, DistanceIsMeasuredFromTheSettledPlace) {
  const Configuration configuration{.environment = Land{}, .device = device()};
  Contest contest = contest_of(1, 0.9, configuration);
  contest.trials.settle = 0.5;
  const auto winners = best_of(contest, make, 1, results).winners;
  ASSERT_EQ(winners.size(), 1u);
  Simulation simulation(configuration, std::vector<Robot>{make(3, 0)});
  simulation.step(500);
  const Vec3 settled = simulation.telemetry(0).center_of_mass;
  simulation.step(400);
  const Vec3 path = simulation.telemetry(0).center_of_mass - settled;
  EXPECT_DOUBLE_EQ(winners[0].result.distance, std::hypot(path.x, path.y));
  EXPECT_GT(winners[0].result.distance, 0);
  EXPECT_EQ(winners[0].result.hash, simulation.hash(0));
}

// The same robots in `mercury run`, in both of its ways, have the same results to the last bit.
TEST_P(BestOf, ResultsAreThoseOfRun) {
  const Configuration configuration{.environment = Land{}, .device = device()};
  const TrialSettings trials{.seconds = 0.7, .settle = 0.3};
  Contest contest = contest_of(5, 0.7, configuration);
  contest.trials = trials;
  std::vector<std::string> searched;
  contest.watch = [&](const RobotResult& robot) { searched.push_back(csv_line(robot)); };
  best_of(contest, make, 1, results);

  const RobotSequence robots{.source = [](std::size_t i) { return std::make_shared<const Robot>(make(3, i)); },
                             .count = 5,
                             .random = {{.kind = "voxel", .count = 5, .seed = 3}}};
  const RunReport evaluated = evaluate(robots, configuration, trials, 3, results);
  GatheredRobots gathered = gather(robots);
  Simulation simulation(configuration, gathered.robots);
  RunReport simulated = simulate(simulation, std::move(gathered.identities), trials, {});
  add_failed(simulated, std::move(gathered.failed));

  ASSERT_EQ(searched.size(), 5u);
  ASSERT_EQ(evaluated.robots.size(), 5u);
  ASSERT_EQ(simulated.robots.size(), 5u);
  for (std::size_t i = 0; i < 5; ++i) {
    EXPECT_EQ(csv_line(evaluated.robots[i]), searched[i]);
    EXPECT_EQ(csv_line(simulated.robots[i]), searched[i]);
  }
  EXPECT_EQ(searched[1],
            "1,voxel-3-1,,voxel:1:3:1,failed,cloud: none" + std::string(result_columns().size() - 6, ',') + "\n");
}

// Three trials with jitter: the figures are the medians of the trials one by one, as a run of each gives them.
TEST_P(BestOf, SeveralTrialsGiveMediansAndQuartiles) {
  const Configuration configuration{.environment = Land{}, .device = device()};
  Contest contest = contest_of(1, 0.7, configuration);
  contest.trials.trials = 3;
  contest.trials.jitter = 1e-3;
  contest.trials.delay = 0;
  const RobotResult best = best_of(contest, make, 1, results).winners.at(0).result;
  std::vector<double> distances;
  for (std::size_t trial = 0; trial < 3; ++trial) {
    const Robot robot = make(3, 0);
    std::vector<Vec3> positions = robot.masses;
    add_jitter(robot, contest.trials, contest.seed, trial, positions);
    Simulation simulation(configuration, std::vector<Robot>{robot});
    simulation.reset_to(positions);
    const Vec3 start = simulation.telemetry(0).center_of_mass;
    simulation.step(700);
    const Vec3 path = simulation.telemetry(0).center_of_mass - start;
    distances.push_back(std::hypot(static_cast<double>(path.x), static_cast<double>(path.y)));
  }
  std::ranges::sort(distances);
  EXPECT_LT(distances[0], distances[2]);
  EXPECT_EQ(best.trials, 3);
  EXPECT_DOUBLE_EQ(best.distance, distances[1]);
  EXPECT_DOUBLE_EQ(best.lower_quartile, (distances[0] + distances[1]) / 2);
  EXPECT_DOUBLE_EQ(best.upper_quartile, (distances[1] + distances[2]) / 2);
}

TEST_P(BestOf, LeavesOutFailedRobotsAndSortsTheOthers) {
  const ContestResult found = best_of(contest_of(5, 0.3, {.device = device()}), make, 5, results);
  ASSERT_EQ(found.winners.size(), 4u);
  for (std::size_t i = 1; i < 4; ++i) EXPECT_GE(found.winners[i - 1].result.distance, found.winners[i].result.distance);
  EXPECT_EQ(found.fates, (std::map<Fate, std::uint64_t>{{Fate::sound, 4}, {Fate::failed, 1}}));
  EXPECT_EQ(found.tried(), 5u);
  EXPECT_FALSE(found.interrupted);
}

// Robots beyond the limit do not win, whatever their distance. The limit is the median strain, so half of them are.
TEST_P(BestOf, IgnoresOverstretchedRobots) {
  Contest contest = contest_of(9, 0.5, {.environment = Land{}, .device = device()});
  std::vector<double> strains;
  contest.watch = [&](const RobotResult& robot) {
    if (robot.was_stepped()) strains.push_back(robot.largest_strain);
  };
  EXPECT_EQ(best_of(contest, make, 9, results).winners.size(), 8u);
  std::ranges::sort(strains);
  contest.watch = {};
  contest.trials.strain_limit = (strains[3] + strains[4]) / 2;
  const ContestResult found = best_of(contest, make, 9, results);
  EXPECT_EQ(found.winners.size(), 4u);
  for (const Winner& winner : found.winners) EXPECT_LE(winner.result.largest_strain, contest.trials.strain_limit);
  EXPECT_EQ(found.fates.at(Fate::overstretched), 4u);
}

// A robot that explodes is thrown far: none of its figures may count. A spring of 50 N/m between two masses of 1 kg is
// unstable from dt = 0.2 s on; masses without springs stay where they are.
TEST_P(BestOf, ExplodedRobotsNeverWin) {
  const auto mixed = [](std::uint64_t, std::uint64_t index) {
    Robot robot{.name = "pair", .masses = {{0, 0, 0}, {1, 0, 0}}};
    if (index % 2 == 0) robot.springs = {{0, 1, 1, 1}};
    return robot;
  };
  Contest contest = contest_of(6, 200, {.dt = 1, .environment = OceanSimple{.point_drag = 0}, .device = device()});
  std::vector<std::size_t> exploded;
  contest.watch = [&](const RobotResult& robot) {
    EXPECT_EQ(std::isnan(robot.distance), robot.exploded());
    EXPECT_EQ(std::isnan(robot.exploded_at), !robot.exploded());
    if (robot.exploded()) exploded.push_back(robot.identity.index);
  };
  const ContestResult found = best_of(contest, mixed, 6, results);
  EXPECT_EQ(exploded, (std::vector<std::size_t>{0, 2, 4}));
  ASSERT_EQ(found.winners.size(), 3u);
  for (std::size_t i = 0; i < 3; ++i) EXPECT_EQ(found.winners[i].result.identity.index, 2 * i + 1);
}

INSTANTIATE_TEST_SUITE_P(Backends, BestOf, every_device, BackendTest::name);

}  // namespace
}  // namespace mercury
