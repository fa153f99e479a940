// SPDX-License-Identifier: Apache-2.0
// Drives: robots of an evaluator move as those of a simulation whose drives a program writes.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <stdexcept>

#include "backend.h"
#include "evaluations.h"
#include "mercury/simulation.h"

namespace mercury {
namespace {

class EvaluatorDrivesOn : public BackendTest {};
INSTANTIATE_TEST_SUITE_P(All, EvaluatorDrivesOn, every_device, BackendTest::name);

constexpr std::int64_t period = 7;

// Every third actuator goes on by itself.
float drive_of(std::size_t robot, std::int64_t period_number, std::size_t actuator) {
  if (actuator % 3 == 2) return std::numeric_limits<float>::quiet_NaN();
  return 0.5f * std::sin(static_cast<float>(robot + 1) + 0.7f * static_cast<float>(period_number) +
                         static_cast<float>(actuator));
}

EvaluationRequest driven(Device device) {
  EvaluationRequest request = usual();
  request.configuration.device = device;
  request.settling = 10;
  request.steps = 40;
  request.sample_every = 9;
  request.hashes = true;
  request.drive_every = period;
  request.drive = [](std::size_t index, const Robot&, std::int64_t number, std::span<float> drives) {
    for (std::size_t a = 0; a < drives.size(); ++a) drives[a] = drive_of(index, number, a);
  };
  return request;
}

// The hash of each robot after that many steps, driven by hand.
std::vector<std::uint64_t> hashes_by_hand(const EvaluationRequest& request, const Robots& robots, std::int64_t steps) {
  Simulation simulation(request.configuration, robots);
  for (std::int64_t step = 0; step < steps; ++step) {
    if (step % period == 0) {
      std::vector<HeldDrive> held;
      for (std::size_t i = 0; i < robots.size(); ++i)
        for (std::size_t a = 0; a < actuators_of(*robots[i]).size(); ++a)
          if (const float drive = drive_of(i, step / period, a); !std::isnan(drive)) held.push_back({i, a, drive});
      simulation.hold_drives(held);
    }
    simulation.step();
  }
  return simulation.hashes();
}

TEST_P(EvaluatorDrivesOn, RobotsMoveAsInASimulationThatIsDriven) {
  const Robots robots = mixed(12);
  EvaluationRequest request = driven(device());
  const std::vector<std::uint64_t> expected = hashes_by_hand(request, robots, 50);
  for (const std::size_t portion : {1, 5, 12}) {
    request.portion = portion;
    const std::vector<Evaluation> results = evaluate(request, robots);
    for (std::size_t i = 0; i < robots.size(); ++i) EXPECT_EQ(results[i].hash, expected[i]) << i;
  }
  request.drive = nullptr;
  EXPECT_NE(evaluate(request, robots).front().hash, expected.front());
}

TEST_P(EvaluatorDrivesOn, RobotsThatARaceLeavesAreDrivenOn) {
  const Robots robots = mixed(12);
  EvaluationRequest request = driven(device());
  const std::vector<std::uint64_t> expected = hashes_by_hand(request, robots, 50);
  request.checks = {20};
  request.goes_on = [](const Evaluation& so_far) { return so_far.index % 3 != 1; };
  const std::vector<std::uint64_t> stopped = hashes_by_hand(request, robots, 30);
  const std::vector<Evaluation> results = evaluate(request, robots);
  for (std::size_t i = 0; i < robots.size(); ++i) EXPECT_EQ(results[i].hash, (i % 3 == 1 ? stopped : expected)[i]) << i;
}

TEST(EvaluatorDrives, NeedAPeriod) {
  EvaluationRequest request = driven({.kind = DeviceKind::cpu});
  request.drive_every = 0;
  EXPECT_THROW(Evaluator(request, source_of({}), 0), std::invalid_argument);
}

}  // namespace
}  // namespace mercury
