// SPDX-License-Identifier: Apache-2.0
// Land: floor, friction and masses that repel.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "backend.h"
#include "bodies.h"
#include "reference.h"

namespace mercury {
namespace {

constexpr Material tissue_like{40, 0, 0, 0};

class OnLand : public BackendTest {
 protected:
  Configuration on_land(const Land& land, Solver solver, double damping = 0.1) const {
    return {.damping = damping, .solver = solver, .environment = land, .device = device()};
  }
};
INSTANTIATE_TEST_SUITE_P(All, OnLand, every_device, BackendTest::name);

float lowest(const std::vector<Vec3>& positions) { return std::ranges::min(positions, {}, &Vec3::z).z; }

TEST_P(OnLand, ARobotIsSetDownWithItsLowestMassOnTheFloor) {
  Robot robot = bodies::random_voxels({.x = 2, .y = 2, .z = 2, .corner = {1, 2, -7}}, 1);
  Simulation simulation(on_land({}, Solver::force), {&robot, 1});
  EXPECT_EQ(lowest(simulation.positions(0)), 0);
  for (std::size_t i = 0; i < robot.masses.size(); ++i) {
    const Vec3 moved = simulation.positions(0)[i] - robot.masses[i];
    EXPECT_EQ(moved.x, 0);
    EXPECT_NEAR(moved.z, 7, 1e-6);
  }
}

TEST_P(OnLand, ADroppedRobotRestsOnTheFloorAndNoMassIsBelowIt) {
  Robot robot = bodies::voxels({.x = 4, .y = 3, .z = 3}, tissue_like);
  bodies::rotate(robot, bodies::random_rotation(2));
  const float bottom = lowest(robot.masses);
  for (Vec3& x : robot.masses) x.z += 0.3f - bottom;
  for (const Solver solver : {Solver::force, Solver::xpbd}) {
    Simulation simulation(on_land({}, solver, 1), {&robot, 1});
    simulation.set_state(0, robot.masses, std::vector<Vec3>(robot.masses.size()));
    for (int look = 0; look < 1000; ++look) {
      simulation.step(10);
      ASSERT_GE(lowest(simulation.positions(0)), 0) << name_of(solver) << " at " << simulation.time() << " s";
    }
    const Telemetry telemetry = simulation.telemetry(0);
    const double mass = static_cast<double>(robot.masses.size());
    EXPECT_EQ(lowest(simulation.positions(0)), 0);
    EXPECT_LT(telemetry.kinetic_energy / mass, 1e-4) << name_of(solver);
    EXPECT_GT(telemetry.center_of_mass.z, 0.08f);
    EXPECT_LT(telemetry.center_of_mass.z, 0.25f);
  }
}

// A slope of angle a is a gravity tilted by a.
Land slope(double tangent, float friction) {
  const double angle = std::atan(tangent);
  return {.gravity = {static_cast<float>(9.81 * std::sin(angle)), 0, static_cast<float>(-9.81 * std::cos(angle))},
          .friction = friction};
}

TEST_P(OnLand, APointOnASlopeHoldsBelowTheFrictionAngleAndSlidesAboveAsCoulombSays) {
  const Robot point = bodies::point();
  for (const Solver solver : {Solver::force, Solver::xpbd})
    for (const float friction : {0.0f, 0.3f, 0.8f, 1.5f}) {
      if (friction > 0) {
        Simulation holds(on_land(slope(0.99 * double{friction}, friction), solver, 0), {&point, 1});
        holds.step(2000);
        EXPECT_EQ(holds.positions(0)[0], Vec3{}) << name_of(solver) << " friction " << friction;
      }
      const double tangent = 1.01 * double{friction} + 0.01;
      Simulation slides(on_land(slope(tangent, friction), solver, 0), {&point, 1});
      slides.step(2000);
      const double angle = std::atan(tangent);
      const double expected = 9.81 * (std::sin(angle) - double{friction} * std::cos(angle)) * 2;  // after 2 s
      EXPECT_NEAR(slides.state(0).velocities[0].x, expected, 0.01 * expected) << name_of(solver) << " " << friction;
    }
}

// Between the two angles a point at rest stays, and one that moves is slowed by the friction of motion alone.
TEST_P(OnLand, StaticFrictionHoldsWhatIsAtRestAndDoesNotSlowWhatMoves) {
  const Robot point = bodies::point();
  const double friction = 0.3, static_friction = 0.6;
  for (const Solver solver : {Solver::force, Solver::xpbd}) {
    const auto on_slope = [&](double tangent) {
      Configuration configuration = on_land(slope(tangent, static_cast<float>(friction)), solver, 0);
      std::get<Plane>(configuration.environment.ground).static_friction = static_cast<float>(static_friction);
      return configuration;
    };
    Simulation holds(on_slope(0.99 * static_friction), {&point, 1});
    holds.step(2000);
    EXPECT_EQ(holds.positions(0)[0], Vec3{}) << name_of(solver);
    const auto acceleration = [&](double tangent) {
      return 9.81 * (std::sin(std::atan(tangent)) - friction * std::cos(std::atan(tangent)));
    };
    Simulation slides(on_slope(1.01 * static_friction), {&point, 1});
    slides.step(2000);
    double expected = 2 * acceleration(1.01 * static_friction);
    EXPECT_NEAR(slides.state(0).velocities[0].x, expected, 0.01 * expected) << name_of(solver);
    Simulation moves(on_slope(0.45), {&point, 1});
    moves.set_state(0, std::vector<Vec3>(1), std::vector<Vec3>{{0.5f, 0, 0}});
    moves.step(1000);
    expected = 0.5 + acceleration(0.45);
    EXPECT_NEAR(moves.state(0).velocities[0].x, expected, 0.01 * expected) << name_of(solver);
  }
}

// A lower coefficient for masses at rest than for those that move has no meaning, and changes nothing.
TEST_P(OnLand, StaticFrictionBelowThatOfMotionDoesNotCount) {
  const Robot block = bodies::voxels({.x = 4, .y = 3, .z = 1}, tissue_like);
  const auto end = [&](float static_friction) {
    Configuration configuration = on_land(slope(0.6, 0.5f), Solver::force, 1);
    std::get<Plane>(configuration.environment.ground).static_friction = static_friction;
    Simulation simulation(configuration, {&block, 1});
    simulation.step(500);
    return simulation.state(0).positions;
  };
  EXPECT_EQ(end(0.4f), end(0));
}

TEST_P(OnLand, ABlockOnASlopeHoldsBelowTheFrictionAngleAndSlidesAbove) {
  const float friction = 0.5f;
  const Robot block = bodies::voxels({.x = 4, .y = 3, .z = 1}, tissue_like);
  for (const Solver solver : {Solver::force, Solver::xpbd}) {
    const auto travel = [&](double tangent, double* final_speed) {
      Simulation simulation(on_land(slope(tangent, friction), solver, 1), {&block, 1});
      simulation.step(2000);
      const float before = simulation.telemetry(0).center_of_mass.x;
      simulation.step(1000);
      *final_speed = simulation.telemetry(0).velocity.x;
      return simulation.telemetry(0).center_of_mass.x - before;
    };
    double speed = 0;
    EXPECT_LT(std::abs(travel(0.9 * double{friction}, &speed)), 1e-4) << name_of(solver);
    const double tangent = 1.2 * double{friction}, angle = std::atan(tangent);
    EXPECT_GT(travel(tangent, &speed), 0.1) << name_of(solver);
    // dv/dt = g (sin a - friction cos a) - damping v, from rest, after 3 s
    const double expected = 9.81 * (std::sin(angle) - double{friction} * std::cos(angle)) * (1 - std::exp(-3));
    EXPECT_NEAR(speed, expected, 0.03 * expected) << name_of(solver);
  }
}

// A sheet of side x side masses, 0.1 m apart. Springs join masses two steps or a knight's move apart, so the contact
// distance, half the shortest spring, is the spacing of the masses: no hole is wide enough for a mass.
void add_sheet(Robot& robot, int side, Vec3 corner) {
  constexpr float spacing = 0.1f;
  const std::size_t first = robot.masses.size();
  const auto mass_at = [&](int x, int y) { return static_cast<std::uint16_t>(static_cast<int>(first) + y * side + x); };
  for (int y = 0; y < side; ++y)
    for (int x = 0; x < side; ++x)
      robot.masses.push_back(corner + spacing * Vec3{static_cast<float>(x), static_cast<float>(y), 0});
  constexpr int moves[][2] = {{2, 0}, {0, 2}, {1, 2}, {2, 1}, {-1, 2}, {-2, 1}};
  for (int y = 0; y < side; ++y)
    for (int x = 0; x < side; ++x)
      for (const auto& move : moves) {
        const int to_x = x + move[0], to_y = y + move[1];
        if (to_x < 0 || to_x >= side || to_y >= side) continue;
        const std::uint16_t a = mass_at(x, y), b = mass_at(to_x, to_y);
        robot.springs.push_back({a, b, 1, rest_distance(robot, a, b)});
      }
}

// 4 x 4 masses above the middle of 8 x 8.
constexpr std::size_t lower_count = 64;
Robot two_sheets(Vec3 offset) {
  Robot robot;
  robot.materials = bodies::one_material(tissue_like);
  add_sheet(robot, 8, {});
  add_sheet(robot, 4, Vec3{0.2f, 0.2f, 0} + offset);
  return robot;
}

// Least height of the upper sheet's masses above the highest mass of the lower one [m].
float gap(const std::vector<Vec3>& positions) {
  const auto upper = positions.begin() + lower_count;
  return lowest({upper, positions.end()}) -
         std::ranges::max(std::vector<Vec3>(positions.begin(), upper), {}, &Vec3::z).z;
}

TEST_P(OnLand, TwoLayersPressedTogetherDoNotPassThroughEachOther) {
  for (const Solver solver : {Solver::force, Solver::xpbd})
    for (const Vec3 offset : {Vec3{0, 0, 0.12f}, Vec3{0.05f, 0.05f, 0.12f}, Vec3{0.031f, 0.012f, 0.12f}}) {
      const Robot robot = two_sheets(offset);
      Land land{.gravity = {0, 0, -30}};  // three times the normal weight
      Simulation collides(on_land(land, solver, 5), {&robot, 1});
      land.self_collision = false;
      Simulation passes(on_land(land, solver, 5), {&robot, 1});
      float least = 1;
      for (int look = 0; look < 200; ++look) {
        collides.step(10);
        least = std::min(least, gap(collides.positions(0)));
      }
      EXPECT_GT(least, 0.01f) << name_of(solver) << " offset " << offset.x;
      passes.step(2000);
      EXPECT_LT(gap(passes.positions(0)), 1e-3f) << name_of(solver) << " offset " << offset.x;
    }
}

// Two masses at distance d, and a spring far away that makes the contact distance 0.5 m.
Robot two_points_beside_a_spring(float distance) {
  Robot robot;
  robot.materials = bodies::one_material(tissue_like);
  robot.masses = {{0, 0, 0}, {distance, 0, 0}, {0, 10, 0}, {1, 10, 0}};
  robot.springs = {{2, 3, 1, 1}};
  return robot;
}

TEST_P(OnLand, MassesThatNoSpringJoinsRepelInProportionToTheMissingDistance) {
  for (const Solver solver : {Solver::force, Solver::xpbd})
    for (const float distance : {0.1f, 0.3f, 0.49f, 0.51f, 0.7f}) {
      const Robot robot = two_points_beside_a_spring(distance);
      const Land land{.gravity = {}, .contact_stiffness = 50, .stiffness_scale = 4};
      Simulation simulation(on_land(land, solver, 0), {&robot, 1});
      simulation.step();
      const double force = 50 * 4 * std::max(0.0, 0.5 - double{distance});
      const State state = simulation.state(0);
      EXPECT_NEAR(state.velocities[0].x, -force * 1e-3, 1e-5) << distance;
      EXPECT_EQ(state.velocities[1].x, -state.velocities[0].x) << distance;
      EXPECT_EQ(state.velocities[2], Vec3{}) << "joined by a spring";
    }
}

// A pile of loose points, as close as the grid of cells allows, follows the brute-force calculation.
TEST_P(OnLand, ACrowdOfLooseMassesFollowsTheReference) {
  Robot robot = bodies::random_voxels({.x = 1, .y = 1, .z = 1, .corner = {-1, -1, 0}}, 1);
  const Robot lattice = bodies::voxels({.x = 5, .y = 5, .z = 3, .edge = 0.04f}, tissue_like);
  const State loose = bodies::shaken(lattice, 0.015f, 0, 4);
  for (const Vec3 x : loose.positions) robot.masses.push_back(x + Vec3{-0.07f, -0.09f, 0.05f});
  struct Case {
    Solver solver;
    double dt;                // [s]
    float contact_stiffness;  // [N/m]
  };
  // The last is stiffer than XPBD accepts at its time step, so it is softened (contact_stiffness_of).
  for (const auto& [solver, dt, contact_stiffness] :
       {Case{Solver::force, 1e-3, 10}, {Solver::xpbd, 1e-3, 10}, {Solver::xpbd, 5e-3, 100}}) {
    Configuration configuration = on_land({.contact_stiffness = contact_stiffness}, solver);
    configuration.dt = dt;
    Simulation simulation(configuration, {&robot, 1});
    reference::Reference expected(configuration, robot);
    double largest = 0;
    for (int look = 0; look < 10; ++look) {
      simulation.step(std::llround(0.01 / dt));
      expected.step(std::llround(0.01 / dt));
      largest = std::max(largest, reference::largest_deviation(expected.positions(), simulation.positions(0)));
    }
    EXPECT_LT(largest, 1e-3) << name_of(solver) << " dt " << dt;
  }
}

}  // namespace
}  // namespace mercury
