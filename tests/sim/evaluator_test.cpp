// SPDX-License-Identifier: Apache-2.0
// The evaluator: its results are those of a simulation, whatever it does to get them.
#include <gtest/gtest.h>

#include <numeric>
#include <set>
#include <thread>

#include "backend.h"
#include "evaluations.h"

namespace mercury {
namespace {

class EvaluatorOn : public BackendTest {};
INSTANTIATE_TEST_SUITE_P(All, EvaluatorOn, every_device, BackendTest::name);

TEST_P(EvaluatorOn, ResultsAreThoseOfASimulation) {
  const Robots robots = mixed(30);
  EvaluationRequest request = usual();
  request.configuration.device = device();
  for (const std::int64_t sample_every : {0, 1, 30, 130, 1000}) {
    request.sample_every = sample_every;
    expect_equal(evaluate(request, robots), simulated(request, robots));
  }
}

TEST_P(EvaluatorOn, ResultsDoNotDependOnPortionsAndWorkers) {
  const Robots robots = mixed(50);
  EvaluationRequest request = usual();
  request.configuration.device = device();
  const std::vector<Evaluation> expected = evaluate(request, robots);
  for (const std::size_t portion : {1, 7, 50})
    for (const int workers : {1, 4}) {
      request.portion = portion;
      request.workers = workers;
      expect_equal(evaluate(request, robots), expected);
    }
}

// More robots come while earlier ones are stepped, and after all of them have been yielded.
TEST_P(EvaluatorOn, ASourceGrows) {
  const Robots robots = mixed(60);
  EvaluationRequest request = usual();
  request.configuration.device = device();
  const std::vector<Evaluation> expected = evaluate(request, robots);
  request.grows = true;
  Evaluator evaluator(request, source_of(robots), 0);
  EXPECT_FALSE(evaluator.next());
  std::vector<Evaluation> all;
  const auto take = [&](std::size_t count) {
    for (std::size_t i = 0; i < count; ++i) {
      std::optional<Evaluation> one = evaluator.next();
      ASSERT_TRUE(one);
      all.push_back(*std::move(one));
    }
  };
  evaluator.extend(20);
  evaluator.extend(7);
  take(20);
  evaluator.extend(13);
  take(20);
  EXPECT_FALSE(evaluator.next());
  evaluator.extend(20);
  take(20);
  EXPECT_FALSE(evaluator.next());
  expect_equal(all, expected);
  evaluator.extend(1);  // the source ends before: nobody waits for it
  EXPECT_FALSE(evaluator.next());
}

TEST(Evaluator, AnErrorOfASourceThatGrowsComesAfterTheResultsBeforeIt) {
  const Robots robots = mixed(10);
  EvaluationRequest request = usual();
  request.grows = true;
  request.portion = 1;
  const RobotSource failing = [&](std::size_t index) {
    if (index == 7) throw std::runtime_error("no more");
    return robots.at(index);
  };
  Evaluator evaluator(request, failing, 5);
  for (int i = 0; i < 5; ++i) EXPECT_TRUE(evaluator.next());
  evaluator.extend(5);
  for (int i = 5; i < 7; ++i) EXPECT_TRUE(evaluator.next());
  EXPECT_THROW(evaluator.next(), std::runtime_error);
}

TEST(Evaluator, OnlyASourceOfAKnownNumberGrows) {
  EvaluationRequest request = usual();
  Evaluator fixed(request, source_of(mixed(1)), 1);
  EXPECT_THROW(fixed.extend(1), std::logic_error);
  request.grows = true;
  EXPECT_THROW(Evaluator(request, source_of(mixed(1))), std::invalid_argument);
}

// Every robot begins in its own way, which does not depend on what it is loaded with.
void displace(std::size_t index, const Robot&, std::span<Vec3> positions) {
  for (std::size_t i = 0; i < positions.size(); ++i)
    positions[i].x += 1e-3f * static_cast<float>((i + index) % 7), positions[i].z -= 1e-3f * static_cast<float>(i % 3);
}

TEST_P(EvaluatorOn, RobotsBeginWhereTheRequestPutsThem) {
  Robots robots = mixed(20);
  for (std::size_t i = 1; i < 6; ++i) robots[i] = robots[0];  // trials of one robot are one object
  EvaluationRequest request = usual();
  request.configuration.device = device();
  request.start = displace;
  const std::vector<Evaluation> expected = simulated(request, robots);
  expect_equal(evaluate(request, robots), expected);
  for (const std::size_t portion : {1, 7}) {
    request.portion = portion;
    expect_equal(evaluate(request, robots), expected);
  }
  EXPECT_NE(expected[0].hash, expected[1].hash);
  request.start = {};
  EXPECT_NE(evaluate(request, robots)[0].hash, expected[0].hash);
}

TEST(Evaluator, ResultsDoNotDependOnDevices) {
  const Robots robots = mixed(50);
  EvaluationRequest request = usual(Ocean{});
  const std::vector<Evaluation> expected = simulated(request, robots);
  request.portion = 3;
  for (const std::size_t devices : {1, 2, 5}) expect_equal(evaluate(request, robots, cpus(devices)), expected);
}

TEST(Evaluator, EveryDeviceWorks) {
  EvaluationRequest request = usual();
  request.steps = 2000;
  request.portion = 1;
  Evaluator evaluator(request, source_of(mixed(60)), 60, cpus(2));
  EXPECT_EQ(rest_of(evaluator).size(), 60u);
  const EvaluationProgress progress = evaluator.progress();
  ASSERT_EQ(progress.devices.size(), 2u);
  EXPECT_EQ(progress.devices[0].robots + progress.devices[1].robots, 60u);
  for (const auto& device : progress.devices) {
    EXPECT_GT(device.robots, 0u);
    EXPECT_GT(device.busy_seconds, 0);
    EXPECT_LE(device.busy_seconds, progress.stepping);
  }
  EXPECT_EQ(evaluator.device_name(), "2 x " + make_cpu_backend({.threads = 1})->device_name());
}

TEST(Evaluator, ATrialOfNoStepsReportsTheStart) {
  EvaluationRequest request = usual();
  request.steps = 0;
  const Robots robots = mixed(3);
  std::vector<Evaluation> expected = simulated(request, robots);
  for (Evaluation& one : expected) one.end = one.start;
  expect_equal(evaluate(request, robots), expected);
}

TEST(Evaluator, CountsRobotsAndSteps) {
  const EvaluationRequest request = usual();
  Evaluator evaluator(request, source_of(mixed(9)), 9);
  EXPECT_EQ(rest_of(evaluator).size(), 9u);
  const EvaluationProgress progress = evaluator.progress();
  EXPECT_EQ(progress.made, 9u);
  EXPECT_EQ(progress.done, 9u);
  EXPECT_EQ(progress.robot_steps, 9 * (20 + 130));
}

TEST(Evaluator, EmptySourceHasNoResults) {
  EXPECT_TRUE(evaluate(usual(), {}).empty());
  Evaluator evaluator(usual(), source_of({}));
  EXPECT_FALSE(evaluator.next());
  EXPECT_FALSE(evaluator.next());
  EXPECT_TRUE(evaluator.wait_for(std::chrono::hours(1)));
}

TEST(Evaluator, SourceOfUnknownLengthEndsWithANull) {
  const Robots robots = mixed(23);
  EvaluationRequest request = usual();
  request.portion = 4;
  Evaluator evaluator(request, source_of(robots));
  expect_equal(rest_of(evaluator), simulated(request, robots));
}

TEST(Evaluator, ASerialSourceIsCalledInOrderByOneThread) {
  const Robots robots = mixed(23);
  EvaluationRequest request = usual();
  request.portion = 4;
  request.serial_source = true;
  std::vector<std::size_t> calls;
  std::set<std::thread::id> threads;
  const RobotSource source = [&](std::size_t index) {
    calls.push_back(index);
    threads.insert(std::this_thread::get_id());
    return index < robots.size() ? robots[index] : nullptr;
  };
  Evaluator evaluator(request, source);
  expect_equal(rest_of(evaluator), simulated(request, robots));
  std::vector<std::size_t> in_order(24);
  std::iota(in_order.begin(), in_order.end(), 0);
  EXPECT_EQ(calls, in_order);
  EXPECT_EQ(threads.size(), 1u);
}

}  // namespace
}  // namespace mercury
