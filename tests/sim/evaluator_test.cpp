// SPDX-License-Identifier: Apache-2.0
// The evaluator: its results are those of a simulation, whatever it does to get them.
#include "mercury/evaluator.h"

#include <gtest/gtest.h>

#include <atomic>
#include <stdexcept>

#include "backend.h"
#include "bodies.h"
#include "mercury/error.h"

namespace mercury {
namespace {

using Robots = std::vector<std::shared_ptr<const Robot>>;

// Robots of several sizes.
Robots mixed(std::size_t count) {
  Robots robots;
  for (std::size_t i = 0; i < count; ++i) {
    const int n = static_cast<int>(i);
    robots.push_back(
        std::make_shared<Robot>(bodies::random_voxels({.x = 1 + n % 3, .y = 1 + n % 2, .z = 1 + n / 3 % 3}, i)));
  }
  return robots;
}

std::vector<Evaluation> rest_of(Evaluator& evaluator) {
  std::vector<Evaluation> all;
  while (std::optional<Evaluation> one = evaluator.next()) all.push_back(*std::move(one));
  return all;
}

std::vector<Evaluation> evaluate(const EvaluationRequest& request, const Robots& robots,
                                 const std::vector<Evaluator::MakeBackend>& devices = {}) {
  Evaluator evaluator(request, source_of(robots), robots.size(), devices);
  return rest_of(evaluator);
}

std::vector<Evaluator::MakeBackend> cpus(std::size_t count) {
  return std::vector<Evaluator::MakeBackend>(count, [] { return make_cpu_backend({.threads = 1}); });
}

void expect_equal(const Telemetry& a, const Telemetry& b) {
  EXPECT_EQ(a.center_of_mass, b.center_of_mass);
  EXPECT_EQ(a.velocity, b.velocity);
  EXPECT_EQ(a.kinetic_energy, b.kinetic_energy);
  EXPECT_EQ(a.elastic_energy, b.elastic_energy);
  EXPECT_EQ(a.largest_strain, b.largest_strain);
  EXPECT_EQ(a.exploded, b.exploded);
  EXPECT_EQ(a.exploded_at, b.exploded_at);
  EXPECT_EQ(a.culprit_spring, b.culprit_spring);
}

void expect_equal(const std::vector<Evaluation>& a, const std::vector<Evaluation>& b) {
  ASSERT_EQ(a.size(), b.size());
  for (std::size_t i = 0; i < a.size(); ++i) {
    EXPECT_EQ(a[i].index, b[i].index);
    EXPECT_EQ(a[i].robot, b[i].robot);
    EXPECT_EQ(a[i].failure, b[i].failure);
    EXPECT_EQ(a[i].steps, b[i].steps);
    expect_equal(a[i].start, b[i].start);
    expect_equal(a[i].end, b[i].end);
    EXPECT_EQ(a[i].path, b[i].path);
    EXPECT_EQ(a[i].largest_strain, b[i].largest_strain);
    EXPECT_EQ(a[i].hash, b[i].hash);
    EXPECT_EQ(a[i].state.positions, b[i].state.positions);
    EXPECT_EQ(a[i].state.velocities, b[i].state.velocities);
  }
}

// What a simulation of all robots gives, step by step.
std::vector<Evaluation> simulated(const EvaluationRequest& request, const Robots& robots) {
  Simulation simulation(request.configuration, robots);
  simulation.step(request.settling);
  const std::vector<Telemetry> start = simulation.telemetry();
  std::vector<Evaluation> expected(robots.size());
  std::vector<Telemetry> last = start;
  for (std::size_t i = 0; i < robots.size(); ++i)
    expected[i] = {.index = i,
                   .robot = robots[i],
                   .steps = request.steps,
                   .start = start[i],
                   .largest_strain = start[i].largest_strain};
  for (std::int64_t step = 1; step <= request.steps; ++step) {
    simulation.step();
    if (step < request.steps && (request.sample_every == 0 || step % request.sample_every != 0)) continue;
    const std::vector<Telemetry> now = simulation.telemetry();
    for (std::size_t i = 0; i < robots.size(); ++i) {
      expected[i].path += static_cast<double>(length(now[i].center_of_mass - last[i].center_of_mass));
      expected[i].largest_strain = std::max(expected[i].largest_strain, static_cast<double>(now[i].largest_strain));
    }
    last = now;
  }
  for (std::size_t i = 0; i < robots.size(); ++i) {
    expected[i].end = last[i];
    if (request.hashes) expected[i].hash = simulation.hash(i);
    if (request.states) expected[i].state = simulation.state(i);
  }
  return expected;
}

EvaluationRequest usual(Environment environment = Land{}) {
  return {.configuration = {.environment = environment, .device = {.kind = DeviceKind::cpu}},
          .settling = 20,
          .steps = 130,
          .sample_every = 30,
          .hashes = true,
          .states = true};
}

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

TEST(Evaluator, RobotsThatCannotBeUsedAreReportedAndDoNotDisturbOthers) {
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

TEST(Evaluator, APortionWithoutAnyUsableRobotIsNoProblem) {
  Evaluator evaluator(
      usual(), [](std::size_t) -> std::shared_ptr<const Robot> { throw InputError("no robot"); }, 3);
  const std::vector<Evaluation> results = rest_of(evaluator);
  ASSERT_EQ(results.size(), 3u);
  for (const Evaluation& result : results) EXPECT_EQ(result.failure, "no robot");
}

TEST(Evaluator, ExplodedRobotsAreReportedAsByASimulation) {
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

TEST(Evaluator, OtherExceptionsOfTheSourceAreThrownAfterTheResultsBefore) {
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
class BrokenBackend final : public Backend {
 public:
  std::string device_name() const override { return "broken"; }
  std::vector<std::string> notes() const override { return {}; }
  std::size_t robots_at_once() const override { return 1; }
  double spring_limit() const override { return 0; }
  double busy_seconds() const override { return 0; }
  void load(std::span<const Robot* const>, const Configuration&) override {}
  void add(std::span<const Robot* const>, std::size_t) override {}
  void keep(std::span<const Robot* const>, std::span<const std::size_t>) override {}
  void configure(const Configuration&) override {}
  void step(const Clock&, std::int64_t) override { throw DeviceError("the device fell off the bus"); }
  void read(std::size_t, std::span<Vec3>, std::span<Vec3>) const override {}
  void write(std::size_t, std::span<const Vec3>, std::span<const Vec3>) override {}
  void read_positions(std::span<Vec3>) const override {}
  void read_velocities(std::span<Vec3>) const override {}
  RobotStatus status(std::size_t) const override { return {}; }
  std::vector<RobotStatus> statuses() const override { return {}; }
  void set_status(std::size_t, const RobotStatus&) override {}
  void write_materials(std::span<const Material>) override {}
  void write_materials(std::size_t, std::span<const Material>) override {}
  void set_perturbations(std::span<const Perturbation>) override {}
  void report(const Clock&, std::span<Telemetry>, std::span<RobotStatus>) const override {}
};

TEST(Evaluator, FailingDevicesAreReportedByNext) {
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

TEST(Evaluator, StopYieldsWhatHasBeenReached) {
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

TEST(Evaluator, AfterStopNoRobotsAreMade) {
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

TEST(Evaluator, CanBeDestroyedAtAnyTime) {
  EvaluationRequest request = usual();
  request.steps = std::int64_t{1} << 60;
  request.portion = 2;
  const Robots robots = mixed(20);
  { const Evaluator at_once(request, source_of(robots), robots.size()); }
  Evaluator stepping(request, source_of(robots), robots.size(), cpus(2));
  while (stepping.progress().robot_steps == 0) EXPECT_FALSE(stepping.wait_for(std::chrono::milliseconds(1)));
}

TEST(Evaluator, RobotsThatExistAtATimeFitIntoTheMemoryLimit) {
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

TEST(Evaluator, RefusesWhatMakesNoSense) {
  EvaluationRequest request = usual();
  request.steps = -1;
  EXPECT_THROW(Evaluator(request, source_of({}), 0), std::invalid_argument);
  request = usual();
  request.configuration.dt = 0;
  EXPECT_THROW(Evaluator(request, source_of({}), 0), InputError);
}

}  // namespace
}  // namespace mercury
