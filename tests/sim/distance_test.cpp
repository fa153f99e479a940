// SPDX-License-Identifier: Apache-2.0
// How far robots get, on every backend, where theory knows it.
#include "mercury/distance.h"

#include <gtest/gtest.h>

#include <cmath>

#include "backend.h"
#include "bodies.h"
#include "mercury/evaluator.h"
#include "mercury/trial_measures.h"

namespace mercury {
namespace {

class Distance : public BackendTest {
 protected:
  static constexpr double g = 9.81;
  static constexpr std::int64_t steps = 1000;

  Configuration configuration(const Environment& environment) const {
    return {.dt = 1e-3, .damping = 0, .environment = environment, .device = device()};
  }
  // The result of a body that flies with this velocity from high above the ground.
  Evaluation flight(const Environment& environment, Vec3 velocity) const {
    Robot robot = bodies::voxels({.x = 2, .y = 1, .z = 1}, {.stiffness = 50});
    robot.masses.push_back({0, 0, -100});  // robots are set down with their lowest mass on the ground
    Simulation simulation(configuration(environment), std::span(&robot, 1));
    State state = bodies::moving(robot, velocity);
    state.positions = simulation.state(0).positions;
    simulation.set_state(0, state);
    TrialMeasures measures(simulation.telemetry(0));
    for (std::int64_t step = 0; step < steps; step += 50) {
      simulation.step(50);
      measures.add(simulation.telemetry(0), 50e-3);
    }
    Evaluation evaluation;
    measures.write(evaluation);
    return evaluation;
  }
};

TEST(DistanceBetween, IsThatAlongTheGroundOnLandAndThroughSpaceElsewhere) {
  EXPECT_DOUBLE_EQ(distance_between({1, 2, 3}, {3, 5, 9}, Land{}), std::sqrt(13.0));
  EXPECT_DOUBLE_EQ(distance_between({1, 2, 3}, {3, 5, 9}, Ocean{}), 7);
  EXPECT_DOUBLE_EQ(distance_between({1, 2, 3}, {3, 5, 9}, OceanSimple{}), 7);
}

// The body falls by g t (t + dt) / 2 with semi-implicit steps. One of its 13 masses stays on the ground.
TEST_P(Distance, AFallOnLandIsNone) {
  const Evaluation fall = flight(Land{}, {});
  const double share = 12.0 / 13, height = share * g * (1 + 1e-3) / 2;
  EXPECT_NEAR(fall.start.center_of_mass.z - fall.end.center_of_mass.z, height, 1e-3);
  EXPECT_NEAR(distance_between(fall.start.center_of_mass, fall.end.center_of_mass, Land{}), 0, 1e-4);
  EXPECT_NEAR(fall.path, height, 1e-3);
  EXPECT_EQ(fall.highest, fall.start.center_of_mass.z);
}

// Thrown with a velocity, the mass on the ground too: x = v t; it rises to v_z^2 / (2 g) above its start and is still
// in the air at the end, since 2 v_z / g > 1 s.
TEST_P(Distance, OfAThrownBodyIsThatOfItsShadow) {
  const Evaluation thrown = flight(Land{}, {3, 4, 5});
  EXPECT_NEAR(distance_between(thrown.start.center_of_mass, thrown.end.center_of_mass, Land{}), 5, 2e-3);
  EXPECT_NEAR(thrown.highest - thrown.start.center_of_mass.z, 25 / (2 * g), 0.01);  // sampled every 0.05 s
}

TEST_P(Distance, InSpaceCountsAllDirections) {
  const Evaluation drifting = flight(empty_space(), {2, 3, 6});
  EXPECT_NEAR(distance_between(drifting.start.center_of_mass, drifting.end.center_of_mass, empty_space()), 7, 2e-3);
  EXPECT_NEAR(drifting.path, 7, 2e-3);
}

// A program that steps a simulation itself measures what an evaluator measures.
TEST_P(Distance, MeasuresAreThoseOfAnEvaluator) {
  const auto robot = std::make_shared<const Robot>(bodies::random_voxels({.x = 3, .y = 2, .z = 2}, 7));
  const EvaluationRequest request{
      .configuration = configuration(Land{}), .settling = 130, .steps = 420, .sample_every = 50, .hashes = true};
  Evaluator evaluator(request, source_of({robot}), 1);
  const Evaluation expected = evaluator.next().value();
  Simulation simulation(request.configuration, std::span(robot.get(), 1));
  simulation.step(request.settling);
  TrialMeasures measures(simulation.telemetry(0));
  for (std::int64_t step = 0; step < request.steps;) {
    const std::int64_t count = std::min(request.sample_every, request.steps - step);
    simulation.step(count);
    measures.add(simulation.telemetry(0), request.configuration.dt * static_cast<double>(count));
    step += count;
  }
  Evaluation found;
  measures.write(found);
  EXPECT_EQ(simulation.hash(0), expected.hash);
  EXPECT_EQ(found.path, expected.path);
  EXPECT_EQ(found.work, expected.work);
  EXPECT_EQ(found.positive_work, expected.positive_work);
  EXPECT_EQ(found.highest, expected.highest);
  EXPECT_EQ(found.largest_strain, expected.largest_strain);
  EXPECT_EQ(found.strained_share, expected.strained_share);
}

INSTANTIATE_TEST_SUITE_P(Backends, Distance, every_device, BackendTest::name);

// Of P = offset + sin t over three periods. With c = offset, P > 0 between -asin c and pi + asin c, so the integral of
// its positive part is 2 (sqrt(1 - c^2) + c (pi / 2 + asin c)) in each period, and that of P is 2 pi c. The error of
// the trapezoid rule is at most T h^2 / 12, that of a corner below h^2.
TEST(TrialMeasures, PositiveWorkIsTheIntegralOfThePowerWhereItIsPositive) {
  constexpr double pi = 3.14159265358979323846;
  constexpr int samples = 3 * 120;
  constexpr double h = 6 * pi / samples;
  for (const double c : {-1.5, -0.6, 0.0, 0.3, 1.25}) {
    TrialMeasures measures({.muscle_power = c});
    for (int i = 1; i <= samples; ++i) measures.add({.muscle_power = c + std::sin(h * i)}, h);
    Evaluation result;
    measures.write(result);
    const double positive = c >= 1    ? 2 * pi * c
                            : c <= -1 ? 0
                                      : 2 * (std::sqrt(1 - c * c) + c * (pi / 2 + std::asin(c)));
    const double accepted = 3 * (2 * pi * h * h / 12 + 2 * h * h);
    EXPECT_NEAR(result.work, 3 * 2 * pi * c, accepted) << c;
    EXPECT_NEAR(result.positive_work, 3 * positive, accepted) << c;
    EXPECT_NEAR(result.absolute_work(), 3 * (2 * positive - 2 * pi * c), 3 * accepted) << c;
  }
}

// Power that goes along a line from 1 W to -3 W in 2 s is positive for half a second.
TEST(TrialMeasures, PowerGoesAlongALineBetweenSamplesAndEndsWithAnExplosion) {
  TrialMeasures measures({.muscle_power = 1});
  measures.add({.muscle_power = -3}, 2);
  measures.add({.muscle_power = 100, .exploded = true}, 2);
  Evaluation result;
  measures.write(result);
  EXPECT_EQ(result.work, -2);
  EXPECT_EQ(result.positive_work, 0.25);
  EXPECT_EQ(result.absolute_work(), 0.25 + 2.25);
}

// However long a trial is, the way takes bounded memory, and the thirds of an even motion are where they belong.
TEST(TrialMeasures, ThirdsAreKnownOfTrialsOfAnyLength) {
  for (const int samples : {1, 2, 3, 200, 511, 512, 513, 5000, 70'001}) {
    TrialMeasures measures{Telemetry{}};
    for (int i = 1; i <= samples; ++i) measures.add({.center_of_mass = {static_cast<float>(i), 0, 0}}, 0.05);
    measures.add({.center_of_mass = {static_cast<float>(samples) + 0.2f, 0, 0}}, 0.01);  // a shorter one at the end
    EXPECT_LE(measures.sums().way.size(), TrialMeasures::longest_way);
    Evaluation result;
    measures.write(result);
    const double all = samples + 0.2;
    EXPECT_NEAR(result.third, 0.05 * all / 3, 1e-9 * all);
    EXPECT_NEAR(result.at_third.x, all / 3, 1e-6 * all + 1e-6) << samples;
    EXPECT_NEAR(result.at_two_thirds.x, 2 * all / 3, 1e-6 * all + 1e-6) << samples;
  }
}

}  // namespace
}  // namespace mercury
