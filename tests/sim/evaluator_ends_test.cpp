// SPDX-License-Identifier: Apache-2.0
// How an evaluation ends other than by its last robot: robots that cannot be used, errors, stop(), the destructor; and
// the memory that it takes.
#include <gtest/gtest.h>

#include <atomic>
#include <stdexcept>

#include "backend.h"
#include "evaluations.h"
#include "mercury/error.h"
#include "tests/nap.h"

namespace mercury {
namespace {

TEST(EvaluatorEnds, RobotsThatCannotBeUsedAreReportedAndDoNotDisturbOthers) {
  const Robots robots = mixed(12);
  Robot invalid = *robots[5];
  invalid.springs[2].b = 60000;
  const RobotSource source = [&](std::size_t index) -> std::shared_ptr<const Robot> {
    if (index == 3) throw InputError("robot 3", "cannot be grown");
    return index == 5 ? std::make_shared<Robot>(invalid) : robots[index];
  };
  for (const std::size_t portion : {1, 4, 12}) {
    EvaluationRequest request = usual();
    request.portion = portion;
    Evaluator evaluator(request, source, robots.size());
    std::vector<Evaluation> results = rest_of(evaluator), expected = simulated(request, robots);
    ASSERT_EQ(results.size(), 12u);
    EXPECT_EQ(results[3].failure, "robot 3: cannot be grown");
    EXPECT_EQ(results[3].robot, nullptr);
    EXPECT_EQ(results[5].failure,
              "/springs/2: mass 60000 is out of range, the robot has " + std::to_string(invalid.masses.size()));
    EXPECT_EQ(results[5].steps, 0);
    for (const std::ptrdiff_t i : {5, 3}) {
      results.erase(results.begin() + i);
      expected.erase(expected.begin() + i);
    }
    expect_equal(results, expected);
    EXPECT_EQ(evaluator.progress().robot_steps, 12 * (20 + 130));
  }
}

TEST(EvaluatorEnds, APortionWithoutAnyUsableRobotIsNoProblem) {
  Evaluator evaluator(
      usual(), [](std::size_t) -> std::shared_ptr<const Robot> { throw InputError("no robot"); }, 3);
  const std::vector<Evaluation> results = rest_of(evaluator);
  ASSERT_EQ(results.size(), 3u);
  for (const Evaluation& result : results) EXPECT_EQ(result.failure, "no robot");
}

TEST(EvaluatorEnds, ExplodedRobotsAreReportedAsByASimulation) {
  // Two masses on a spring of 50 N/m: omega = sqrt(2 k / m) = 10 rad/s, unstable for dt > 2 / omega = 0.2 s.
  Robot pair = bodies::pair({.stiffness = 50});
  pair.masses[1].x = 1.1f;
  EvaluationRequest request = usual(empty_space());
  request.configuration.dt = 1;
  request.configuration.damping = 0;
  const Robots robots{std::make_shared<Robot>(bodies::point()), std::make_shared<Robot>(pair)};
  const std::vector<Evaluation> results = evaluate(request, robots);
  expect_equal(results, simulated(request, robots));
  EXPECT_FALSE(results[0].end.exploded);
  EXPECT_TRUE(results[1].end.exploded);
  EXPECT_EQ(results[1].end.culprit_spring, 0u);
  EXPECT_EQ(results[1].failure, "");
}

TEST(EvaluatorEnds, OtherExceptionsOfTheSourceAreThrownAfterTheResultsBefore) {
  const Robots robots = mixed(30);
  EvaluationRequest request = usual();
  request.portion = 5;
  Evaluator evaluator(
      request,
      [&](std::size_t index) {
        if (index == 20) throw std::runtime_error("disk on fire");
        return robots[index];
      },
      robots.size());
  for (std::size_t i = 0; i < 20; ++i) EXPECT_EQ(evaluator.next()->index, i);
  for (int again = 0; again < 2; ++again) EXPECT_THROW(evaluator.next(), std::runtime_error);
}

// A device that fails in the first step.
class BrokenBackend : public Backend {
 public:
  std::string device_name() const override { return "broken"; }
  std::vector<std::string> notes() const override { return {}; }
  std::size_t robots_at_once() const override { return 1; }
  double spring_limit() const override { return 0; }
  double busy_seconds() const override { return 0; }
  void load(std::span<const Robot* const> robots, const Configuration&) override { size_ = robots.size(); }
  void add(std::span<const Robot* const> robots, std::size_t) override { size_ = robots.size(); }
  void keep(std::span<const Robot* const> robots, std::span<const std::size_t>) override { size_ = robots.size(); }
  void configure(const Configuration&) override {}
  void step(const Clock&, std::int64_t) override { throw DeviceError("the device fell off the bus"); }
  void read(std::size_t, std::span<Vec3>, std::span<Vec3>) const override {}
  void write(std::size_t, std::span<const Vec3>, std::span<const Vec3>) override {}
  void read_positions(std::span<Vec3>) const override {}
  void read_velocities(std::span<Vec3>) const override {}
  RobotStatus status(std::size_t) const override { return {}; }
  std::vector<RobotStatus> statuses() const override { return std::vector<RobotStatus>(size_); }
  void set_status(std::size_t, const RobotStatus&) override {}
  void write_materials(std::span<const Material>) override {}
  void write_materials(std::size_t, std::span<const Material>) override {}
  void set_perturbations(std::span<const Perturbation>) override {}
  void report(const Clock&, std::span<Telemetry>, std::span<RobotStatus>) const override {}

 private:
  std::size_t size_ = 0;  // robots
};

TEST(EvaluatorEnds, FailingDevicesAreReportedByNext) {
  EvaluationRequest request = usual();
  request.portion = 2;
  Evaluator stepping(request, source_of(mixed(20)), 20, {[] { return std::make_unique<BrokenBackend>(); }});
  EXPECT_THROW(rest_of(stepping), DeviceError);

  std::vector<Evaluator::MakeBackend> devices = cpus(1);
  devices.push_back([]() -> std::unique_ptr<Backend> { throw DeviceError("no such device"); });
  Evaluator starting(request, source_of(mixed(20)), Evaluator::unknown_count, devices);
  EXPECT_THROW(rest_of(starting), DeviceError);
  EXPECT_THROW(starting.device_name(), DeviceError);
}

TEST(EvaluatorEnds, StopYieldsWhatHasBeenReached) {
  const Robots robots = mixed(6);
  EvaluationRequest request = usual();
  request.settling = 0;
  request.steps = std::int64_t{1} << 60;
  Evaluator evaluator(request, source_of(robots), robots.size());
  while (evaluator.progress().robot_steps == 0) EXPECT_FALSE(evaluator.wait_for(std::chrono::milliseconds(1)));
  evaluator.stop();
  const std::vector<Evaluation> results = rest_of(evaluator);
  ASSERT_EQ(results.size(), 6u);
  EXPECT_GT(results[0].steps, 0);
  request.steps = results[0].steps;
  expect_equal(results, simulated(request, robots));
}

TEST(EvaluatorEnds, AfterStopNoRobotsAreMade) {
  const std::shared_ptr<const Robot> robot = mixed(1).front();
  std::atomic<std::size_t> made = 0;
  EvaluationRequest request = usual();
  request.portion = 4;
  Evaluator evaluator(request, [&](std::size_t) { return ++made, robot; });  // endless
  for (std::size_t i = 0; i < 10; ++i) EXPECT_EQ(evaluator.next()->index, i);
  evaluator.stop();
  std::size_t index = 10;
  for (const Evaluation& result : rest_of(evaluator)) EXPECT_EQ(result.index, index++);
  EXPECT_LE(index, made);
}

// A device that takes no step. Robots of which the first is `slow` are loaded when `loads` says so.
class SlowBackend final : public BrokenBackend {
 public:
  struct Gate {
    const Robot* slow = nullptr;
    std::atomic<bool> waits = false, opens = false;
  };
  explicit SlowBackend(Gate& gate) : gate_(gate) {}
  void load(std::span<const Robot* const> robots, const Configuration& configuration) override {
    BrokenBackend::load(robots, configuration);
    pass(robots);
  }
  void add(std::span<const Robot* const> robots, std::size_t first_new) override {
    BrokenBackend::add(robots, first_new);
    pass(robots);
  }
  void step(const Clock&, std::int64_t) override {}

 private:
  void pass(std::span<const Robot* const> robots) {
    if (robots.empty() || robots.front() != gate_.slow) return;
    gate_.waits = true;
    gate_.waits.notify_all();
    gate_.opens.wait(false);
  }
  Gate& gate_;
};

TEST(EvaluatorEnds, StopKeepsWhatWasTriedBehindRobotsThatHaveNotStarted) {
  const Robots robots = mixed(20);
  SlowBackend::Gate gate{.slow = robots[4].get()};
  EvaluationRequest request = usual();
  request.portion = 2;
  request.workers = 1;
  const Evaluator::MakeBackend device = [&] { return std::make_unique<SlowBackend>(gate); };
  Evaluator evaluator(request, source_of(robots), robots.size(), {device, device});
  gate.waits.wait(false);
  while (evaluator.progress().done < 18) test::nap();
  evaluator.stop();
  gate.opens = true;
  gate.opens.notify_all();
  std::vector<std::size_t> tried;
  for (const Evaluation& result : rest_of(evaluator)) {
    EXPECT_EQ(result.steps, request.steps);
    tried.push_back(result.index);
  }
  EXPECT_EQ(tried, (std::vector<std::size_t>{0, 1, 2, 3, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15, 16, 17, 18, 19}));
}

// A device for a thousand robots that counts those it has loaded, and steps them only when it may.
class PatientBackend final : public BrokenBackend {
 public:
  struct Gate {
    std::atomic<std::size_t> robots = 0, portions = 0;
    std::atomic<bool> opens = false;
  };
  explicit PatientBackend(Gate& gate) : gate_(gate) {}
  std::size_t robots_at_once() const override { return 1000; }
  void add(std::span<const Robot* const> robots, std::size_t first_new) override {
    BrokenBackend::add(robots, first_new);
    gate_.robots += robots.size() - first_new;
    ++gate_.portions;
    gate_.portions.notify_all();
  }
  void step(const Clock&, std::int64_t) override { gate_.opens.wait(false); }

 private:
  Gate& gate_;
};

TEST(EvaluatorEnds, PortionsDoubleWhileADeviceIsNotFull) {
  PatientBackend::Gate gate;
  const auto wait_for_portions = [&](std::size_t count) {
    for (std::size_t now = gate.portions; now < count; now = gate.portions) gate.portions.wait(now);
  };
  EvaluationRequest request = usual();
  request.grows = true;
  request.workers = 4;
  const std::shared_ptr<const Robot> robot = std::make_shared<Robot>(bodies::point());
  Evaluator evaluator(request, [&](std::size_t) { return robot; }, 1,
                      {[&] { return std::make_unique<PatientBackend>(gate); }});
  wait_for_portions(1);  // now it is known how many robots the device steps at once
  evaluator.extend(4000);
  wait_for_portions(4);
  // One robot, then at least one and two pieces of 256; the fourth portion waits for as many robots as all these.
  EXPECT_GE(gate.robots, 2 * (1 + 256 + 257));
  gate.opens = true;
  gate.opens.notify_all();
  EXPECT_EQ(rest_of(evaluator).size(), 4001u);
}

TEST(EvaluatorEnds, CanBeDestroyedAtAnyTime) {
  EvaluationRequest request = usual();
  request.steps = std::int64_t{1} << 60;
  request.portion = 2;
  const Robots robots = mixed(20);
  { const Evaluator at_once(request, source_of(robots), robots.size()); }
  Evaluator stepping(request, source_of(robots), robots.size(), cpus(2));
  while (stepping.progress().robot_steps == 0) EXPECT_FALSE(stepping.wait_for(std::chrono::milliseconds(1)));
}

TEST(EvaluatorEnds, RobotsThatExistAtATimeFitIntoTheMemoryLimit) {
  const Robot robot = bodies::random_voxels({.x = 3, .y = 3, .z = 3}, 1);
  const std::size_t bytes =
      robot.masses.size() * sizeof(Vec3) + robot.springs.size() * sizeof(Spring) + robot.faces.size() * sizeof(Face);
  constexpr std::size_t count = 300;
  const auto most_alive = [&](std::size_t memory_limit) {
    std::atomic<std::size_t> alive = 0, most = 0;
    const RobotSource source = [&](std::size_t) {
      for (std::size_t now = ++alive, known = most; now > known && !most.compare_exchange_weak(known, now);) {
      }
      return std::shared_ptr<const Robot>(new Robot(robot), [&alive](const Robot* gone) {
        --alive;
        delete gone;
      });
    };
    EvaluationRequest request = usual();
    request.memory_limit = memory_limit;
    Evaluator evaluator(request, source, count);
    std::size_t yielded = 0;
    while (evaluator.next()) ++yielded;
    EXPECT_EQ(yielded, count);
    EXPECT_EQ(alive, 0u);
    return most.load();
  };
  EXPECT_LE(most_alive(100 * bytes), 100u);
  EXPECT_LE(most_alive(1), 2u);                        // one, while the caller still has the previous one
  EXPECT_EQ(most_alive(std::size_t{1} << 40), count);  // where memory does not limit it, this is one portion
}

TEST(EvaluatorEnds, RefusesWhatMakesNoSense) {
  EvaluationRequest request = usual();
  request.steps = -1;
  EXPECT_THROW(Evaluator(request, source_of({}), 0), std::invalid_argument);
  request = usual();
  request.configuration.dt = 0;
  EXPECT_THROW(Evaluator(request, source_of({}), 0), InputError);
}

}  // namespace
}  // namespace mercury
