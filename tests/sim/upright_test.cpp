// SPDX-License-Identifier: Apache-2.0
// How upright a body is: by known angles, and of a tower that falls over.
#include <gtest/gtest.h>

#include <cmath>

#include "backend.h"
#include "bodies.h"
#include "mercury/evaluator.h"
#include "mercury/trial_measures.h"

namespace mercury {
namespace {

class UprightOn : public BackendTest {};
INSTANTIATE_TEST_SUITE_P(All, UprightOn, every_device, BackendTest::name);

// The robot turned about its vertical axis by `yaw`, then tilted about the y axis by `tilt`, and moved [rad].
std::vector<Vec3> turned(const Robot& robot, float yaw, float tilt) {
  std::vector<Vec3> positions;
  const float cy = std::cos(yaw), sy = std::sin(yaw), ct = std::cos(tilt), st = std::sin(tilt);
  for (const Vec3 p : robot.masses) {
    const Vec3 q{cy * p.x - sy * p.y, sy * p.x + cy * p.y, p.z};
    positions.push_back({ct * q.x + st * q.z + 0.3f, q.y - 2, -st * q.x + ct * q.z + 5});
  }
  return positions;
}

TEST_P(UprightOn, IsTheCosineOfTheTiltWhateverTheHeading) {
  const Robot robot = bodies::voxels({.x = 3, .y = 2, .z = 1}, {50, 0, 0, 0});
  Simulation simulation({.environment = empty_space(), .device = device()}, std::vector{robot, robot});
  EXPECT_TRUE(std::isnan(simulation.telemetry(1).upright)) << "nobody asked";
  simulation.measure_upright(true);
  for (const float yaw : {0.0f, 1.0f, 4.0f})
    for (const float tilt : {0.0f, 0.3f, 1.5707963f, 2.0f, 3.1415927f}) {
      std::vector<Vec3> positions = turned(robot, yaw, tilt);
      positions.insert(positions.end(), robot.masses.begin(), robot.masses.end());
      simulation.reset_to(positions);
      const std::vector<Telemetry> telemetry = simulation.telemetry();
      EXPECT_NEAR(telemetry[0].upright, std::cos(tilt), 1e-5) << yaw << " " << tilt;
      EXPECT_NEAR(telemetry[1].upright, 1, 1e-6);
    }
}

// A tower of voxels that leans beyond its edge falls onto its side.
TEST_P(UprightOn, ATowerThatFallsOverGoesFromItsTiltToZero) {
  const auto tower = std::make_shared<const Robot>(bodies::voxels({.x = 2, .y = 2, .z = 6}, {50, 0, 0, 0}));
  const std::vector<Vec3> start = turned(*tower, 0, 0.6f);
  EvaluationRequest request{
      .configuration = {.environment = Land{}, .device = device()}, .steps = 2000, .sample_every = 50};
  request.start = [&](std::size_t, const Robot&, std::span<Vec3> positions) {
    std::ranges::copy(start, positions.begin());
  };
  request.upright = true;
  const Evaluation result = Evaluator(request, source_of({tower}), 1).next().value();
  EXPECT_NEAR(result.start.upright, std::cos(0.6), 1e-5);
  EXPECT_NEAR(result.end.upright, 0, 0.1);

  // From the middles of its ends, at each sample.
  Simulation simulation(request.configuration, std::vector{*tower});
  simulation.reset_to(start);
  const auto leaning = [&] {
    const std::vector<Vec3> positions = simulation.positions(0);
    Vec3 low, high;
    for (std::size_t i = 0; i < positions.size(); ++i) {
      if (tower->masses[i].z < 0.05f) low = low + positions[i];
      if (tower->masses[i].z > 0.55f) high = high + positions[i];
    }
    const Vec3 axis = high - low;
    return static_cast<double>(axis.z / length(axis));
  };
  double sum = 0, last = leaning();
  for (int sample = 0; sample < 40; ++sample) {
    simulation.step(50);
    const double now = leaning();
    sum += (last + now) / 2;
    last = now;
  }
  EXPECT_NEAR(result.upright, sum / 40, 0.03);
  EXPECT_NEAR(result.end.upright, last, 0.05);

  request.upright = false;
  EXPECT_TRUE(std::isnan(Evaluator(request, source_of({tower}), 1).next().value().upright));
}

TEST(Upright, OfATrialIsTheMeanUntilTheRobotExplodes) {
  const auto at = [](float upright) {
    Telemetry telemetry;
    telemetry.upright = upright;
    return telemetry;
  };
  TrialMeasures measures(at(1));
  Evaluation result;
  measures.write(result);
  EXPECT_EQ(result.upright, 1) << "a trial of no time";
  measures.add(at(0.5f), 1);
  measures.add(at(-0.5f), 3);
  measures.write(result);
  EXPECT_DOUBLE_EQ(result.upright, (0.75 * 1 + 0 * 3) / 4);
  Telemetry exploded;
  exploded.exploded = true;
  measures.add(exploded, 5);
  measures.write(result);
  EXPECT_DOUBLE_EQ(result.upright, 0.75 / 4);
}

}  // namespace
}  // namespace mercury
