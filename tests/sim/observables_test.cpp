// SPDX-License-Identifier: Apache-2.0
// Observables against their definitions, an independent calculation, and the simulation itself.
#include "mercury/observables.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "backend.h"
#include "bodies.h"
#include "reference.h"

namespace mercury {
namespace {

constexpr Material muscle{50, 0.14f, 3, 0.4f};

// One voxel, shaken, with the default materials.
Robot shaken_robot(State& state) {
  Robot robot = bodies::random_voxels({.x = 2, .y = 2, .z = 1}, 4);
  state = bodies::shaken(robot, 0.01f, 0.3f, 5);
  return robot;
}

TEST(Observables, AMaterialFollowsItsMuscleCurveAndTheEnvironmentScalesItsStiffness) {
  for (const double time : {0.0, 0.7, 12.3, 1e6}) {
    const std::vector<Material> table{{}, muscle};
    const MaterialNow now = materials_at(table, Land{.stiffness_scale = 200}, time).at(1);
    const double angle = 3 * time + double{muscle.phase};
    EXPECT_EQ(now.stiffness, 200 * 50.0f);
    EXPECT_NEAR(now.length_factor, 1 + 0.14 * std::sin(angle), 1e-6) << time;
    EXPECT_NEAR(now.length_rate, 0.14 * 3 * std::cos(angle), 3e-6) << time;
    EXPECT_NEAR(contraction(muscle, time), -0.14 * std::sin(angle), 1e-6) << time;
  }
}

TEST(Observables, AHalfWaveIsInTheContraction) {
  Material half = muscle;
  half.half_wave = true;
  for (const double time : {0.0, 0.7, 1.5, 2.2}) {
    const double sine = std::min(0.0, std::sin(3 * time + double{muscle.phase}));
    EXPECT_NEAR(contraction(half, time), -0.14 * sine, 1e-6) << time;
    EXPECT_NEAR(materials_at(std::array{half}, Ocean{}, time).at(0).length_factor, 1 + 0.14 * sine, 1e-6) << time;
  }
}

TEST(Observables, AClockGivesTheSameAsItsTime) {
  const Clock clock{.dt = 2e-3, .base_time = 1.25, .base_step = 700, .step = 1950};
  const std::vector<Material> table{{}, muscle};
  const MaterialNow by_clock = materials_at(table, Ocean{}, clock).at(1);
  const MaterialNow by_time = materials_at(table, Ocean{}, time_of(clock)).at(1);
  EXPECT_NEAR(by_clock.length_factor, by_time.length_factor, 1e-6);
  EXPECT_NEAR(by_clock.length_rate, by_time.length_rate, 1e-6);
}

TEST(Observables, AMassIsHeavyAndDraggedByWaterThatActsOnMasses) {
  const Environment simple = OceanSimple{.point_drag = 3, .flow = {1, 0, 0}, .gravity = {0, 0, -2}};
  EXPECT_EQ(mass_force(simple, 0.5f, {0, 4, 0}), (Vec3{3, -12, -1}));
  EXPECT_EQ(mass_force(Ocean{.flow = {1, 0, 0}}, 0.5f, {0, 4, 0}), Vec3{});
}

TEST(Observables, AMeanOverMassesIsWeighted) {
  Robot robot{.name = "pair", .masses = {{0, 0, 0}, {4, 0, 8}}};
  EXPECT_EQ(mean_over_masses(robot, robot.masses), (std::array<double, 3>{2, 0, 4}));
  robot.mass = {3, 1};
  EXPECT_EQ(mean_over_masses(robot, robot.masses), (std::array<double, 3>{1, 0, 2}));
}

TEST(Observables, ASpringOfTwoMasses) {
  const Spring spring{.a = 0, .b = 1, .material = 1, .rest_length = 0.5f};
  const std::vector<Vec3> positions = {{0, 0, 0}, {0, 0.3f, 0.4f}};
  const std::vector<Vec3> longer = {{0, 0, 0}, {0, 0.6f, 0.8f}};
  const MaterialNow now{.stiffness = 40, .length_factor = 1.1f, .length_rate = 0.2f};
  EXPECT_FLOAT_EQ(spring_length(spring, positions), 0.5f);
  EXPECT_FLOAT_EQ(strain(1.0f, 0.5f), 1.0f);
  EXPECT_NEAR(stretch(spring, now, positions), -0.05f, 1e-7f);
  EXPECT_NEAR(stretch(spring, now, longer), 0.45f, 1e-7f);
  EXPECT_FLOAT_EQ(spring_force(40.0f, 0.45f), 18);
  EXPECT_DOUBLE_EQ(elastic_energy(40.0, 0.45), 4.05);
  // The muscle lengthens while it is pulled: the body does work on it.
  EXPECT_FLOAT_EQ(muscle_power(spring, now, 0.45f), -18 * 0.5f * 0.2f);
}

TEST(Observables, MusclePowerIsTheEnergyThatTheChangeOfRestLengthAdds) {
  const Spring spring{.a = 0, .b = 1, .material = 1, .rest_length = 0.5f};
  const std::vector<Material> table{{}, muscle};
  const double distance = 0.53, dt = 1e-5;
  const auto energy = [&](double time) {
    const double rest = 0.5 * (1 + double{muscle.amplitude} * std::sin(3 * time + double{muscle.phase}));
    return 0.5 * 50 * (distance - rest) * (distance - rest);
  };
  for (const double time : {0.0, 0.5, 1.0, 1.5}) {
    const MaterialNow now = materials_at(table, Ocean{}, time).at(1);
    const float too_long = stretch(static_cast<float>(distance), spring.rest_length, now.length_factor);
    EXPECT_NEAR(muscle_power(spring, now, too_long), (energy(time + dt) - energy(time - dt)) / (2 * dt), 1e-5) << time;
  }
}

TEST(Observables, SpringForcesAreMinusTheGradientOfTheElasticEnergy) {
  State state;
  const Robot robot = shaken_robot(state);
  const auto materials = materials_at(materials_of(robot), Ocean{}, 0.8);
  const auto energy = [&](std::size_t mass, float Vec3::*axis, double by) {
    double sum = 0;
    for (const Spring& spring : robot.springs) {
      double squared = 0;
      for (float Vec3::*along : {&Vec3::x, &Vec3::y, &Vec3::z}) {
        double d = double{state.positions[spring.b].*along} - double{state.positions[spring.a].*along};
        if (along == axis) d += by * ((spring.b == mass) - (spring.a == mass));
        squared += d * d;
      }
      const MaterialNow& material = materials[spring.material];
      const double rest = double{spring.rest_length} * double{material.length_factor};
      sum += 0.5 * double{material.stiffness} * std::pow(std::sqrt(squared) - rest, 2);
    }
    return sum;
  };
  const std::vector<Vec3> forces = spring_forces(robot, materials, state.positions);
  ASSERT_EQ(forces.size(), robot.masses.size());
  for (std::size_t mass = 0; mass < forces.size(); ++mass)
    for (float Vec3::*axis : {&Vec3::x, &Vec3::y, &Vec3::z}) {
      const double gradient = (energy(mass, axis, 1e-5) - energy(mass, axis, -1e-5)) / 2e-5;
      EXPECT_NEAR(forces[mass].*axis, -gradient, 1e-4) << mass;
    }
}

TEST(Observables, MassesInOnePlaceExertNoForce) {
  const Robot robot = bodies::pair({50, 0, 0, 0});
  const std::vector<Vec3> positions(2, {1, 2, 3});
  for (const Vec3 force : spring_forces(robot, materials_at(materials_of(robot), Ocean{}, 0.0), positions))
    EXPECT_EQ(force, Vec3{});
}

TEST(Observables, AFaceAcrossTheFlowFeelsDragAndAnInclinedOneLiftAsWell) {
  const Face face{0, 1, 2};
  const std::vector<Vec3> still(3);
  const Ocean ocean{.flow = {2, 0, 0}};
  // Across: area 0.5, u = 2, both terms point downstream and C_L cancels.
  const std::vector<Vec3> across = {{0, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  const FaceForce upright = face_force(ocean, face, across, still);
  EXPECT_FLOAT_EQ(upright.area, 0.5f);
  EXPECT_NEAR(upright.center.y, 1.0f / 3, 1e-6);
  EXPECT_NEAR(upright.drag.x, 1000 * 0.5 / 2 * 4, 1e-3);
  EXPECT_NEAR(length(upright.lift), 0, 1e-3);
  // Inclined: the two parts are perpendicular.
  const std::vector<Vec3> inclined = {{0, 0, 0}, {0, 1, 0}, {1, 0, 1}};
  const FaceForce tilted = face_force(ocean, face, inclined, still);
  EXPECT_GT(length(tilted.lift), 1);
  EXPECT_NEAR(dot(tilted.lift, tilted.drag), 0, 1e-3f * dot(tilted.drag, tilted.drag));
  EXPECT_TRUE(has_face_forces(ocean));
  EXPECT_FALSE(has_face_forces(OceanSimple{}));
  EXPECT_FALSE(has_face_forces(Land{}));
  EXPECT_EQ(face_force(Land{}, face, inclined, still).drag, Vec3{});
}

TEST(Observables, TheFloorHoldsARestingMassAgainstItsWeightAndFrictionIsLimited) {
  const Robot robot = bodies::point();
  const Configuration land{.environment = Land{.friction = 0.5f}};
  const std::vector<Vec3> at_floor(1), above(1, {0, 0, 0.1f}), still(1), sliding(1, {3, 0, 0});
  const auto resting = floor_forces(robot, land, {}, at_floor, still);
  ASSERT_EQ(resting.size(), 1u);
  EXPECT_EQ(resting[0].mass, 0u);
  EXPECT_NEAR(resting[0].force.z, 9.81, 1e-5);
  EXPECT_EQ(resting[0].force.x, 0);
  const auto slid = floor_forces(robot, land, {}, at_floor, sliding);
  EXPECT_NEAR(slid.at(0).force.x, -0.5 * 9.81, 1e-4);
  EXPECT_TRUE(floor_forces(robot, land, {}, above, still).empty());
  Configuration sticky = land;
  std::get<Plane>(sticky.environment.ground).static_friction = 0.8f;
  sticky.environment.gravity.x = 0.7f * 9.81f;
  EXPECT_NEAR(floor_forces(robot, sticky, {}, at_floor, still).at(0).force.x, -0.7 * 9.81, 1e-4);
  EXPECT_NEAR(floor_forces(robot, sticky, {}, at_floor, sliding).at(0).force.x, -0.5 * 9.81, 1e-4);
  EXPECT_TRUE(floor_forces(robot, {}, {}, at_floor, still).empty());
}

// Telemetry is computed by the backend from the same formulas.
class ObservablesOf : public EveryPair {};
INSTANTIATE_TEST_SUITE_P(All, ObservablesOf, every_pair, EveryPair::name);

TEST_P(ObservablesOf, ABatchAddUpToItsTelemetry) {
  State state;
  const Robot robot = shaken_robot(state);
  Simulation simulation(configuration(), std::span(&robot, 1));
  for (Vec3& x : state.positions) x.z += 0.1f;
  simulation.set_state(0, state.positions, state.velocities);
  simulation.step(100);
  const auto materials = materials_at(materials_of(robot), configuration().environment, simulation.clock());
  const std::vector<Vec3> positions = simulation.positions(0);
  double energy = 0, power = 0;
  float largest = 0;
  for (const Spring& spring : robot.springs) {
    const MaterialNow& material = materials[spring.material];
    energy += elastic_energy(double{material.stiffness}, double{stretch(spring, material, positions)});
    power += double{muscle_power(spring, material, stretch(spring, material, positions))};
    largest = std::max(largest, std::abs(strain(spring_length(spring, positions), spring.rest_length)));
  }
  const Telemetry telemetry = simulation.telemetry(0);
  EXPECT_NEAR(telemetry.elastic_energy, energy, 1e-4 * energy);
  EXPECT_NEAR(telemetry.muscle_power, power, 1e-4 * std::abs(power));
  EXPECT_NEAR(telemetry.largest_strain, largest, 1e-5);
}

}  // namespace
}  // namespace mercury
