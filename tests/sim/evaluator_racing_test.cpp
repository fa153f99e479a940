// SPDX-License-Identifier: Apache-2.0
// Racing: robots that are removed have the results of a shorter trial, and the others those of a trial without racing.
#include <gtest/gtest.h>

#include <atomic>
#include <map>
#include <mutex>
#include <stdexcept>

#include "backend.h"
#include "evaluations.h"

namespace mercury {
namespace {

class EvaluatorRacesOn : public BackendTest {};
INSTANTIATE_TEST_SUITE_P(All, EvaluatorRacesOn, every_device, BackendTest::name);

// Checks on, between and right after samples, which come every 30 of 130 steps.
const std::vector<std::int64_t> checks{31, 60, 100, 129};

// At check c, robots with these indices are removed: about half of all come to the end.
bool index_goes_on(const Evaluation& so_far) {
  const auto check = static_cast<std::size_t>(std::ranges::find(checks, so_far.steps) - checks.begin());
  return so_far.index % 8 != check;
}

// What a race with index_goes_on() gives: results of trials of different lengths.
std::vector<Evaluation> expected_race(EvaluationRequest request, const Robots& robots) {
  std::vector<Evaluation> expected = simulated(request, robots);
  for (std::size_t check = 0; check < checks.size(); ++check) {
    request.steps = checks[check];
    const std::vector<Evaluation> shorter = simulated(request, robots);
    for (std::size_t i = check; i < robots.size(); i += 8) expected[i] = shorter[i];
  }
  return expected;
}

EvaluationRequest race(Device device = {.kind = DeviceKind::cpu}) {
  EvaluationRequest request = usual();
  request.configuration.device = device;
  request.checks = checks;
  request.goes_on = index_goes_on;
  return request;
}

TEST_P(EvaluatorRacesOn, RobotsHaveTheResultsOfATrialThatEndsWhereTheyAreRemoved) {
  const Robots robots = mixed(30);
  EvaluationRequest request = race(device());
  for (const std::int64_t sample_every : {0, 1, 30, 1000}) {
    request.sample_every = sample_every;
    expect_equal(evaluate(request, robots), expected_race(request, robots));
  }
}

TEST_P(EvaluatorRacesOn, ResultsDoNotDependOnPortionsAndWorkers) {
  const Robots robots = mixed(50);
  EvaluationRequest request = race(device());
  const std::vector<Evaluation> expected = expected_race(request, robots);
  for (const std::size_t portion : {1, 7, 50})
    for (const int workers : {1, 4}) {
      request.portion = portion;
      request.workers = workers;
      expect_equal(evaluate(request, robots), expected);
    }
}

TEST_P(EvaluatorRacesOn, DecisionsSeeWhatHasBeenReached) {
  const Robots robots = mixed(12);
  EvaluationRequest request = race(device());
  std::mutex mutex;
  std::map<std::int64_t, std::vector<Evaluation>> seen;
  request.goes_on = [&](const Evaluation& so_far) {
    const std::lock_guard lock(mutex);
    seen[so_far.steps].push_back(so_far);
    return true;
  };
  const std::vector<Evaluation> results = evaluate(request, robots);
  request.hashes = request.states = false;
  ASSERT_EQ(seen.size(), checks.size());
  for (auto& [check, all] : seen) {
    std::ranges::sort(all, {}, &Evaluation::index);
    EvaluationRequest until = request;
    until.steps = check;
    expect_equal(all, simulated(until, robots));
  }
  request = usual();
  request.configuration.device = device();
  expect_equal(results, simulated(request, robots));  // all went on
}

TEST(EvaluatorRacing, AllRobotsCanBeRemoved) {
  const Robots robots = mixed(9);
  EvaluationRequest request = race();
  request.portion = 4;
  request.goes_on = [](const Evaluation&) { return false; };
  Evaluator evaluator(request, source_of(robots), robots.size());
  const std::vector<Evaluation> results = rest_of(evaluator);
  EXPECT_EQ(evaluator.progress().robot_steps, 9 * (20 + 130));
  request.steps = checks.front();
  expect_equal(results, simulated(request, robots));
}

TEST(EvaluatorRacing, RobotsThatExplodeAndRobotsThatCannotBeUsedKeepTheirPlaces) {
  // Unstable, as in EvaluatorEnds.ExplodedRobotsAreReportedAsByASimulation.
  Robot pair = bodies::pair({.stiffness = 50});
  pair.masses[1].x = 1.1f;
  Robot invalid = pair;
  invalid.springs[0].b = 7;
  Robots robots;
  for (int i = 0; i < 3; ++i) {
    robots.push_back(std::make_shared<Robot>(invalid));
    robots.push_back(std::make_shared<Robot>(bodies::point()));
    robots.push_back(std::make_shared<Robot>(pair));
  }
  EvaluationRequest request = race();
  request.configuration = {.dt = 1, .damping = 0, .environment = empty_space(), .device = {.kind = DeviceKind::cpu}};
  request.goes_on = [](const Evaluation& so_far) { return !so_far.end.exploded || so_far.index == 5; };
  const std::vector<Evaluation> results = evaluate(request, robots);
  ASSERT_EQ(results.size(), 9u);
  for (std::size_t i = 0; i < 9; ++i) {
    EXPECT_EQ(results[i].index, i);
    EXPECT_EQ(results[i].robot, robots[i]);
    EXPECT_EQ(results[i].failure.empty(), i % 3 != 0);
    EXPECT_EQ(results[i].end.exploded, i % 3 == 2);
    const bool is_removed = i == 2 || i == 8;
    EXPECT_EQ(results[i].steps, i % 3 == 0 ? 0 : is_removed ? checks.front() : request.steps) << i;
  }
}

// The first robot of each two is removed; the other would go on for ever.
TEST(EvaluatorRacing, StopYieldsWhatRemovedAndPresentRobotsHaveReached) {
  const Robots robots = mixed(4);
  EvaluationRequest request = race();
  request.settling = 0;
  request.steps = std::int64_t{1} << 60;
  request.checks = {50};
  request.goes_on = [](const Evaluation& so_far) { return so_far.index % 2 != 0; };
  Evaluator evaluator(request, source_of(robots), robots.size());
  const std::int64_t of_removed = 2 * request.steps;
  while (evaluator.progress().robot_steps <= of_removed + 2 * 50)
    EXPECT_FALSE(evaluator.wait_for(std::chrono::milliseconds(1)));
  evaluator.stop();
  const std::vector<Evaluation> results = rest_of(evaluator);
  ASSERT_EQ(results.size(), 4u);
  EXPECT_GT(results[1].steps, 50);
  request.steps = results[1].steps;
  std::vector<Evaluation> expected = simulated(request, robots);
  request.steps = 50;
  const std::vector<Evaluation> removed = simulated(request, robots);
  for (const std::size_t i : {0, 2}) expected[i] = removed[i];
  expect_equal(results, expected);
}

TEST(EvaluatorRacing, CanBeDestroyedWhileRobotsAreAskedAbout) {
  EvaluationRequest request = race();
  request.steps = std::int64_t{1} << 60;
  request.portion = 2;
  std::atomic<int> asked = 0;
  request.goes_on = [&](const Evaluation& so_far) { return ++asked, so_far.index % 3 == 0; };
  Evaluator evaluator(request, source_of(mixed(20)), 20, cpus(2));
  while (asked == 0) (void)evaluator.wait_for(std::chrono::milliseconds(1));
}

TEST(EvaluatorRacing, AnExceptionOfTheDecisionIsThrownByNext) {
  EvaluationRequest request = race();
  request.portion = 5;
  request.goes_on = [](const Evaluation& so_far) -> bool {
    if (so_far.index == 12) throw std::runtime_error("no idea");
    return true;
  };
  Evaluator evaluator(request, source_of(mixed(20)), 20);
  for (std::size_t i = 0; i < 10; ++i) EXPECT_EQ(evaluator.next()->index, i);
  EXPECT_THROW(evaluator.next(), std::runtime_error);
}

TEST(EvaluatorRacing, RefusesChecksThatMakeNoSense) {
  for (const std::vector<std::int64_t>& wrong :
       std::vector<std::vector<std::int64_t>>{{0, 50}, {-3}, {50, 50}, {60, 50}, {130}, {50, 200}}) {
    EvaluationRequest request = race();
    request.checks = wrong;
    EXPECT_THROW(Evaluator(request, source_of({}), 0), std::invalid_argument);
  }
  EvaluationRequest request = race();
  request.goes_on = nullptr;
  EXPECT_THROW(Evaluator(request, source_of({}), 0), std::invalid_argument);
}

}  // namespace
}  // namespace mercury
