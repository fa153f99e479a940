// SPDX-License-Identifier: Apache-2.0
// Water that pushes only faces that move outward, and meets them halfway to the mass behind: against theory, against
// the reference, and which mass is behind a face.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <random>
#include <vector>

#include "backend.h"
#include "bench/cpu_lattice.h"
#include "bodies.h"
#include "mercury/observables.h"
#include "mixed_robots.h"
#include "reference.h"
#include "sim/physics/face_backs.h"

namespace mercury {
namespace {

using reference::Reference;

constexpr float edge = 0.1f;

// Without tangential drag, added mass and gravity.
Environment water(bool one_sided, Vec3 flow = {}) {
  return {.water = ResistiveDrag{
              .tangential_coefficient = 0, .added_mass_coefficient = 0, .flow = flow, .one_sided = one_sided}};
}

Vec3 middle_of(const Robot& robot, const Face& face) {
  return (1.0f / 3) * (robot.masses[face.a] + robot.masses[face.b] + robot.masses[face.c]);
}
Vec3 outward_of(const Robot& robot, const Face& face) {
  const Vec3 normal = cross(robot.masses[face.b] - robot.masses[face.a], robot.masses[face.c] - robot.masses[face.a]);
  return (1 / length(normal)) * normal;
}

// Holes give convex and concave edges, walls of one voxel, and voxels that meet at an edge.
TEST(FaceBacks, OfVoxelsAreAcrossTheVoxelBehindTheSide) {
  for (std::uint64_t seed = 1; seed <= 10; ++seed) {
    const Robot robot = bench::scrambled(bench::lattice_with_holes(5, 0.4, seed), seed);
    const FaceBacks backs(robot);
    for (const Face& face : robot.faces) {
      const Vec3 way = robot.masses[backs.behind(face)] - middle_of(robot, face);
      EXPECT_NEAR(dot(way, outward_of(robot, face)), -edge, 1e-5f);
      EXPECT_NEAR(length(way), edge * std::sqrt(1 + 8.0f / 9), 1e-5f);  // (2/3, 2/3, 1)
      EXPECT_EQ(backs.behind(face), backs.behind({face.c, face.a, face.b}));
      EXPECT_EQ(backs.behind(face), backs.behind({face.b, face.a, face.c}));
    }
  }
}

TEST(FaceBacks, OfATetrahedronIsItsFourthCornerAndASheetHasNone) {
  Robot robot{.masses = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0.2f, 0.2f, 0.7f}, {1, 1, 0}}};
  for (std::uint16_t a = 0; a < 4; ++a)
    for (std::uint16_t b = 0; b < a; ++b) robot.springs.push_back({a, b, 1, 1});
  EXPECT_EQ(FaceBacks(robot).behind({0, 1, 2}), 3);
  EXPECT_EQ(FaceBacks(robot).behind({1, 3, 0}), 2);
  std::erase_if(robot.springs, [](const Spring& s) { return s.a == 3 || s.b == 3; });
  for (std::uint16_t a = 0; a < 3; ++a) robot.springs.push_back({4, a, 1, 1});
  EXPECT_EQ(FaceBacks(robot).behind({1, 0, 2}), 1);  // mass 4 is in the plane
  EXPECT_EQ(FaceBacks(robot).behind({0, 3, 2}), 0);
}

class OneSidedWater : public BackendTest {
 protected:
  Configuration configuration(const Environment& environment) const {
    return {.damping = 0, .environment = environment, .device = device()};
  }
};
INSTANTIATE_TEST_SUITE_P(All, OneSidedWater, every_device, BackendTest::name);

// M v' = -rho / 2 C_N A v^2, so v = v0 / (1 + v0 t / s) with s = 2 M / (rho C_N A). Water on both sides slows it twice
// as much. A body that rests in a flow is carried as one that moves is slowed.
TEST_P(OneSidedWater, SlowsARigidCubeByItsWindwardSideAlone) {
  Robot robot = bodies::voxels({.x = 2, .y = 2, .z = 2}, {.stiffness = 2e4f, .relaxation_time = 1e-3f});
  robot.mass.assign(robot.masses.size(), 1.0f / 27);
  const double speed = 0.5, area = 4 * edge * edge, time = 0.2;
  for (const bool one_sided : {true, false}) {
    const double way = 2 * 1 / (1000 * area) / (one_sided ? 1 : 2);
    const double expected = speed / (1 + speed * time / way);
    const Vec3 fast{0, 0, static_cast<float>(speed)};
    Configuration setting = configuration(water(one_sided));
    setting.dt = 1e-4;
    Simulation moving(setting, {&robot, 1});
    moving.set_state(0, robot.masses, std::vector<Vec3>(robot.masses.size(), fast));
    setting.environment = water(one_sided, -fast);
    Simulation resting(setting, {&robot, 1});
    moving.step(2000);
    resting.step(2000);
    EXPECT_NEAR(moving.telemetry(0).velocity.z, expected, 0.01 * speed) << one_sided;
    EXPECT_NEAR(resting.telemetry(0).velocity.z + speed, expected, 0.01 * speed) << one_sided;
  }
}

TEST_P(OneSidedWater, PullsNoMassOfTheLeewardSide) {
  Robot robot = bodies::voxels({.x = 2, .y = 1, .z = 2}, {.stiffness = 1});
  Simulation simulation(configuration(water(true)), {&robot, 1});
  const Vec3 along{0.2f, 0, 0.3f};
  simulation.set_state(0, robot.masses, std::vector<Vec3>(robot.masses.size(), along));
  simulation.step(1);
  const std::vector<Vec3> velocities = simulation.state(0).velocities;
  for (std::size_t i = 0; i < velocities.size(); ++i) {
    EXPECT_EQ(velocities[i].x<along.x - 1e-6f, robot.masses[i].x> 1.5f * edge) << i;
    EXPECT_EQ(velocities[i].z<along.z - 1e-6f, robot.masses[i].z> 1.5f * edge) << i;
    EXPECT_NEAR(velocities[i].y, 0, 1e-6f);
  }
}

// The middle of a voxel that swells in place rests, however its sides move.
TEST_P(OneSidedWater, DoesNotFeelAVoxelThatBreathesInPlace) {
  Robot robot = bodies::voxels({.x = 1, .y = 1, .z = 1, .corner = {-edge / 2, -edge / 2, -edge / 2}},
                               {.stiffness = 100, .amplitude = 0.2f, .frequency = 8});
  robot.mass.assign(robot.masses.size(), 1.0f / 8);
  Simulation in_space(configuration(empty_space()), {&robot, 1}), one_sided(configuration(water(true)), {&robot, 1}),
      two_sided(configuration(water(false)), {&robot, 1});
  float most = 0, least = 1, difference = 0;
  for (int look = 0; look < 20; ++look) {
    for (Simulation* simulation : {&in_space, &one_sided, &two_sided}) simulation->step(50);
    const auto x = in_space.positions(0), same = one_sided.positions(0), other = two_sided.positions(0);
    for (std::size_t i = 0; i < x.size(); ++i) {
      EXPECT_LT(length(x[i] - same[i]), 1e-5f);
      difference = std::max(difference, length(x[i] - other[i]));
    }
    most = std::max(most, length(x[7] - x[0])), least = std::min(least, length(x[7] - x[0]));
  }
  EXPECT_GT(most - least, 0.2f * edge);  // it does breathe
  EXPECT_GT(difference, 2e-4f);
}

TEST_P(OneSidedWater, VertexOrdersOfFacesDoNotMatter) {
  const Robot robot = bodies::random_voxels({.x = 4, .y = 3, .z = 2}, 1);
  Robot turned = robot;
  std::mt19937 random(1);
  for (Face& face : turned.faces) {
    std::array corners{face.a, face.b, face.c};
    std::ranges::shuffle(corners, random);
    face = {corners[0], corners[1], corners[2]};
  }
  // Of the skin, volumes are computed, too, but their sign counts: buoyancy and added mass are zero without gravity.
  const std::array both{robot, turned};
  Simulation simulation(configuration(water(true, {0.3f, 0.1f, -0.2f})), both);
  simulation.step(300);
  EXPECT_EQ(simulation.hash(0), simulation.hash(1));
}

// In groups of the CPU the same pair of faces may have its body above for one robot and below for another.
TEST_P(OneSidedWater, ARobotMovesInABatchAsItDoesAlone) {
  const std::vector<Robot> robots = test::mixed_robots(16);
  const Configuration setting = configuration(water(true, {0, 0, 0.4f}));
  Simulation together(setting, robots);
  together.step(150);
  for (std::size_t i = 0; i < robots.size(); ++i) {
    Simulation alone(setting, {&robots[i], 1});
    alone.step(70);
    alone.step(80);
    EXPECT_EQ(together.hash(i), alone.hash(0)) << i;
  }
}

TEST_P(OneSidedWater, ItCanBeginAndEndInTheMiddleForAllRobotsOrForOne) {
  std::vector<Robot> robots;
  for (std::uint64_t seed = 1; seed <= 5; ++seed)
    robots.push_back(bodies::random_voxels({.x = 3, .y = 2, .z = 2}, seed));
  const Vec3 flow{0, 0, 0.5f};
  const Configuration one_sided = configuration(water(true, flow)), two_sided = configuration(water(false, flow));
  Simulation switched(two_sided, robots), ones(one_sided, robots), twos(two_sided, robots);
  switched.step(50);
  const auto follow = [&](Simulation& other) {
    for (std::size_t i = 0; i < robots.size(); ++i) other.set_state(i, switched.state(i));
    other.set_clock(switched.clock());
  };
  const auto step = [&] {
    for (Simulation* simulation : {&switched, &ones, &twos}) simulation->step(50);
  };
  switched.configure(one_sided);
  follow(ones);
  step();
  EXPECT_EQ(switched.hashes(), ones.hashes());
  EXPECT_NE(switched.hash(0), twos.hash(0));
  switched.configure(two_sided);
  follow(ones);
  follow(twos);
  switched.set_environments(std::array<std::size_t, 1>{2}, std::array{one_sided.environment});
  step();
  for (std::size_t i = 0; i < robots.size(); ++i)
    EXPECT_LT(length(switched.telemetry(i).center_of_mass - (i == 2 ? ones : twos).telemetry(i).center_of_mass), 1e-6f);
  EXPECT_GT(length(ones.telemetry(2).center_of_mass - twos.telemetry(2).center_of_mass), 1e-4f);
}

class OneSidedAgreement : public EveryPair {};
INSTANTIATE_TEST_SUITE_P(All, OneSidedAgreement,
                         testing::Combine(every_device, testing::Values(Solver::force, Solver::xpbd),
                                          testing::Values("resistive", "water", "resistive+ground")),
                         EveryPair::name);

TEST_P(OneSidedAgreement, ABodyWithHolesFollowsTheReference) {
  Robot robot = bench::lattice_with_holes(4, 0.3, 3);
  const auto apart = static_cast<std::uint16_t>(robot.masses.size());  // a face that nothing is behind
  for (const Vec3 x : {Vec3{0, 0, 1}, Vec3{0.1f, 0, 1}, Vec3{0, 0.1f, 1}}) robot.masses.push_back(x);
  for (std::uint16_t i = 0; i < 3; ++i) {
    const auto a = static_cast<std::uint16_t>(apart + i), b = static_cast<std::uint16_t>(apart + (i + 1) % 3);
    robot.springs.push_back({a, b, 21, rest_distance(robot, a, b)});
  }
  robot.faces.push_back({apart, static_cast<std::uint16_t>(apart + 1), static_cast<std::uint16_t>(apart + 2)});
  Configuration setting = configuration();
  auto& drag = std::get<ResistiveDrag>(setting.environment.water);
  drag.one_sided = true;
  drag.tangential_coefficient = 0.2f;
  drag.flow = {0.2f, 0.1f, -0.1f};
  Simulation simulation(setting, {&robot, 1});
  Reference expected(setting, robot);
  for (int look = 0; look < 10; ++look) {
    simulation.step(60);
    expected.step(60);
    ASSERT_LT(reference::largest_deviation(expected.positions(), simulation.positions(0)),
              has_ground(setting.environment) ? 1e-3 : 1e-4)
        << look;
  }
}

// What pictures show is what the solvers compute.
TEST(OneSidedWaterShown, ForcesOnFacesChangeTheMomentumAsAStepDoes) {
  const Robot robot = bench::lattice_with_holes(3, 0.3, 1);
  const Environment environment = water(true, {0.1f, 0, 0});
  const State state = bodies::shaken(robot, 0.01f, 0.5f, 1);
  const std::vector<std::uint16_t> behind = masses_behind_faces(robot, environment);
  Vec3 force, both_sides;
  for (std::size_t i = 0; i < robot.faces.size(); ++i) {
    const auto on_face = [&](const FaceForce& f) { return f.drag + f.lift; };
    force += on_face(face_force(environment, robot.faces[i], state.positions, state.velocities, behind[i]));
    both_sides += on_face(face_force(environment, robot.faces[i], state.positions, state.velocities));
  }
  Simulation simulation({.damping = 0, .environment = environment, .device = {.kind = DeviceKind::cpu}}, {&robot, 1});
  simulation.set_state(0, state);
  simulation.step(1);
  Vec3 gained;
  const std::vector<Vec3> velocities = simulation.state(0).velocities;
  for (std::size_t i = 0; i < velocities.size(); ++i) gained += velocities[i] - state.velocities[i];
  EXPECT_LT(length(1000.0f * gained - force), 2e-3f * length(force));
  EXPECT_GT(length(both_sides - force), 0.1f * length(force));
}

}  // namespace
}  // namespace mercury
