// SPDX-License-Identifier: Apache-2.0
// The window's physics: on its own thread it gives the same states as a simulation, bit for bit.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "app/live/physics.h"
#include "app/recording/recorder.h"
#include "mercury/random_voxel.h"
#include "tests/app/program.h"
#include "tests/nap.h"

namespace mercury {
namespace {

Configuration in_environment(Environment environment = Ocean{}) {
  return {.environment = environment, .device = {.kind = DeviceKind::cpu, .threads = 1}};
}

std::vector<LiveRobot> some_robots(std::size_t count) {
  std::vector<LiveRobot> live;
  for (Robot& robot : random_voxel_robots({}, 5, count)) {
    std::string name = robot.name;
    live.push_back(
        {.id = live.size() + 1, .name = std::move(name), .robot = std::make_shared<const Robot>(std::move(robot))});
  }
  return live;
}

class RecordedPhysics : public test::FolderTest {};

// A simulation of the same robots, for comparison.
Simulation alone(const std::vector<LiveRobot>& live, const Configuration& configuration) {
  std::vector<Robot> robots;
  for (const LiveRobot& robot : live) robots.push_back(*robot.robot);
  return Simulation(configuration, robots);
}

std::vector<Vec3> positions_of(const Snapshot& snapshot) {
  const auto positions = snapshot.positions.host();
  return {positions.begin(), positions.end()};
}

std::vector<Vec3> positions_of(const Simulation& simulation) {
  std::vector<Vec3> positions(simulation.mass_count());
  simulation.read_positions(positions);
  return positions;
}

// The robots have just been put in; their first steps are those of a simulation.
void expect_first_steps(PhysicsThread& physics, const std::vector<LiveRobot>& robots) {
  physics.step(5);
  physics.wait_until_done();
  Simulation simulation = alone(robots, in_environment());
  simulation.step(5);
  EXPECT_EQ(positions_of(*physics.newest()), positions_of(simulation));
}

// A time step that no simulation takes, and with it all that a user may change at the same moment.
TEST(LivePhysics, WhatComesWithASceneThatFailsTakesEffect) {
  Messages messages;
  PhysicsThread physics(in_environment(), messages);
  const auto robots = some_robots(2);
  physics.set_scene(robots, in_environment());
  physics.set_speed(unlimited_speed);
  physics.play();
  while (physics.newest()->steps < 10) test::nap();  // commands wait for the end of a slice of steps
  Configuration impossible = in_environment();
  impossible.dt = -1;
  physics.set_scene(robots, impossible);
  physics.set_view({.color = &color_quantity("strain")});
  physics.set_speed(3);
  physics.wait_until_done();
  const auto snapshot = physics.newest();
  EXPECT_EQ(messages.take().size(), 1u);
  EXPECT_FALSE(snapshot->playing);
  EXPECT_EQ(snapshot->speed, 3);
  EXPECT_EQ(snapshot->color->key, "strain");
  physics.set_scene(robots, in_environment());
  physics.step(1);
  physics.wait_until_done();
  EXPECT_EQ(physics.newest()->robots->size(), 2u);
  EXPECT_TRUE(messages.take().empty());
}

// The masses of the recording are not those of the robots.
TEST_F(RecordedPhysics, WhatComesWithARecordingThatCannotBeShownTakesEffect) {
  Simulation other(in_environment(), std::vector{*some_robots(3).back().robot});
  Recorder(other, path("other.h5"), {.last_step = 0}).finish();
  Messages messages;
  PhysicsThread physics(in_environment(), messages);
  const auto robots = some_robots(2);
  physics.set_scene(robots, in_environment());
  physics.set_speed(unlimited_speed);
  physics.play();
  while (physics.newest()->steps < 10) test::nap();  // commands wait for the end of a slice of steps
  const std::vector<LivePerturbation> pull{{.robot = 1, .mass = 0, .target = {1, 0, 0}, .stiffness = 20}};
  physics.set_view({.color = &color_quantity("strain")});
  physics.set_speed(3);
  physics.play();
  physics.set_recording(robots, in_environment(), 0, std::make_shared<TrajectoryReader>(path("other.h5")));
  physics.set_perturbations(pull);
  physics.wait_until_done();
  const auto snapshot = physics.newest();
  EXPECT_EQ(messages.take().size(), 1u);
  EXPECT_FALSE(snapshot->playing);
  EXPECT_FALSE(snapshot->timeline.recording);
  EXPECT_EQ(snapshot->speed, 3);
  EXPECT_EQ(snapshot->color->key, "strain");
  EXPECT_EQ(snapshot->perturbations, pull);
  physics.set_perturbations({});
  physics.set_scene({}, in_environment());
  physics.set_scene(robots, in_environment());
  physics.reset();
  expect_first_steps(physics, robots);
  EXPECT_TRUE(messages.take().empty());
}

TEST(LivePhysics, StepsGiveTheStatesOfTheSimulation) {
  for (const Environment& environment : {Environment(Ocean{}), Environment(Land{})}) {
    Messages messages;
    PhysicsThread physics(in_environment(environment), messages);
    const auto robots = some_robots(3);
    physics.set_scene(robots, in_environment(environment));
    physics.step(500);
    physics.step(137);
    physics.wait_until_done();
    Simulation simulation = alone(robots, in_environment(environment));
    simulation.step(637);
    const auto snapshot = physics.newest();
    EXPECT_EQ(snapshot->steps, 637);
    EXPECT_EQ(snapshot->time, simulation.time());
    EXPECT_EQ(positions_of(*snapshot), positions_of(simulation));
    EXPECT_EQ(snapshot->telemetry[1].kinetic_energy, simulation.telemetry(1).kinetic_energy);
    EXPECT_TRUE(messages.take().empty());
  }
}

// Otherwise robots would start at a step that depends on how long they took to load.
TEST(LivePhysics, TimeStandsStillWithoutRobots) {
  Messages messages;
  PhysicsThread physics(in_environment(), messages);
  physics.set_speed(unlimited_speed);
  physics.play();
  physics.step(5);
  for (int i = 0; i < 50; ++i) {
    physics.wait_until_done();
    EXPECT_EQ(physics.newest()->steps, 0);
  }
  const auto robots = some_robots(1);
  physics.pause();
  physics.set_scene(robots, in_environment());
  expect_first_steps(physics, robots);
}

TEST(LivePhysics, PlayingUntilPausedGivesTheStatesOfTheSimulation) {
  Messages messages;
  PhysicsThread physics(in_environment(), messages);
  const auto robots = some_robots(2);
  physics.set_scene(robots, in_environment());
  physics.set_speed(unlimited_speed);
  physics.play();
  while (physics.newest()->steps < 300) test::nap();
  physics.pause();
  physics.wait_until_done();
  const auto snapshot = physics.newest();
  EXPECT_FALSE(snapshot->playing);
  Simulation simulation = alone(robots, in_environment());
  simulation.step(snapshot->steps);
  EXPECT_EQ(positions_of(*snapshot), positions_of(simulation));
}

TEST(LivePhysics, ResetReturnsToRestAtTimeZero) {
  Messages messages;
  PhysicsThread physics(in_environment(), messages);
  const auto robots = some_robots(2);
  physics.set_scene(robots, in_environment());
  physics.wait_until_done();
  const auto start = physics.newest();
  physics.step(50);
  physics.wait_until_done();
  EXPECT_NE(positions_of(*physics.newest()), positions_of(*start));
  physics.reset();
  physics.wait_until_done();
  EXPECT_EQ(positions_of(*physics.newest()), positions_of(*start));
  EXPECT_EQ(physics.newest()->steps, 0);
  EXPECT_EQ(physics.newest()->resets, start->resets + 1);
}

TEST(LivePhysics, RobotsKeepTheirStateWhenOthersAreAddedAndRemoved) {
  Messages messages;
  PhysicsThread physics(in_environment(), messages);
  const auto robots = some_robots(3);
  physics.set_scene({robots[0], robots[1]}, in_environment());
  physics.step(40);
  physics.wait_until_done();
  physics.set_scene({robots[2], robots[1]}, in_environment());
  physics.step(60);
  physics.wait_until_done();
  const auto snapshot = physics.newest();
  Simulation simulation = alone(robots, in_environment());
  simulation.step(100);
  const auto expected = simulation.positions(1);
  EXPECT_TRUE(std::ranges::equal(snapshot->positions_of(1), expected));
  EXPECT_EQ(snapshot->robots->robots[0].id, robots[2].id);
  // The first robot comes back with its state of step 40.
  physics.set_scene(robots, in_environment());
  physics.wait_until_done();
  Simulation until_40 = alone(robots, in_environment());
  until_40.step(40);
  EXPECT_TRUE(std::ranges::equal(physics.newest()->positions_of(0), until_40.positions(0)));
  EXPECT_TRUE(std::ranges::equal(physics.newest()->positions_of(1), expected));
}

TEST(LivePhysics, PerturbationMovesTheCenterOfMassByItsForce) {
  // Empty space without damping: the only outer force is k (target - x) on one mass.
  Configuration space = in_environment(OceanSimple{.point_drag = 0});
  space.damping = 0;
  Messages messages;
  PhysicsThread physics(space, messages);
  Robot point{.name = "point", .masses = {{0, 0, 0}}};
  physics.set_scene({{.id = 7, .robot = std::make_shared<const Robot>(point)}}, space);
  physics.set_perturbations({{.robot = 7, .mass = 0, .target = {1, 0, 0}, .stiffness = 20}, {.robot = 8, .mass = 3}});
  physics.step(1);
  physics.wait_until_done();
  // 20 N act on 1 kg for 1 ms.
  EXPECT_NEAR(physics.newest()->velocities[0].x, 0.02, 1e-6);
  ASSERT_EQ(physics.newest()->perturbations.size(), 1u) << "perturbations on missing robots are ignored";
  physics.step(249);
  physics.wait_until_done();
  // x = 1 - cos(omega t), omega = sqrt(20); the positions of the integrator are half a step ahead.
  EXPECT_NEAR(positions_of(*physics.newest())[0].x, 1 - std::cos(std::sqrt(20.0) * 0.2505), 1e-4);
}

TEST(LivePhysics, ExplosionIsReportedOnceAndPausesOnRequest) {
  Configuration wild = in_environment();
  wild.dt = 1;
  Messages messages;
  PhysicsThread physics(wild, messages);
  const auto robots = some_robots(1);
  physics.pause_on_explosion(true);
  physics.set_scene(robots, wild);
  physics.set_speed(unlimited_speed);
  physics.play();
  physics.wait_until_done();
  while (physics.newest()->stops == 0) test::nap();
  physics.wait_until_done();
  const auto snapshot = physics.newest();
  EXPECT_FALSE(snapshot->playing);
  EXPECT_TRUE(snapshot->telemetry[0].exploded);
  const auto explosions = physics.take_explosions();
  ASSERT_EQ(explosions.size(), 1u);
  EXPECT_EQ(explosions[0].robot, robots[0].id);
  EXPECT_EQ(explosions[0].time, snapshot->telemetry[0].exploded_at);
  EXPECT_LT(explosions[0].culprit_spring, robots[0].robot->springs.size());
  physics.step(5);
  physics.wait_until_done();
  EXPECT_TRUE(physics.take_explosions().empty());
  // After a reset it can explode again.
  physics.reset();
  physics.step(200);
  physics.wait_until_done();
  EXPECT_EQ(physics.take_explosions().size(), 1u);
}

TEST(LivePhysics, FailedSceneIsReportedAndTheNextOneIsSimulated) {
  Messages messages;
  PhysicsThread physics(in_environment(), messages);
  auto robots = some_robots(2);
  physics.set_scene(robots, in_environment());
  physics.step(5);
  physics.wait_until_done();
  const LiveRobot impossible{.id = 9, .robot = std::make_shared<const Robot>()};
  physics.set_scene({robots[0], impossible}, in_environment());
  physics.wait_until_done();
  EXPECT_EQ(messages.take().size(), 1u);
  EXPECT_EQ(physics.newest()->robots->size(), 0u);
  EXPECT_EQ(physics.newest()->positions.size(), 0u);
  physics.set_scene(robots, in_environment());
  expect_first_steps(physics, robots);
  EXPECT_TRUE(messages.take().empty());
}

TEST(LivePhysics, DetailsThatTheEnvironmentLacksAreIgnored) {
  Messages messages;
  PhysicsThread physics(in_environment(), messages);
  ViewSettings view{.color = &color_quantity("pressure")};
  view.shown.arrows.drag = true;
  physics.set_view(view);
  physics.set_scene(some_robots(1), in_environment());
  physics.step(3);
  physics.wait_until_done();
  EXPECT_EQ(physics.newest()->color, &color_quantity("pressure"));
  EXPECT_FALSE(physics.newest()->details.values.face.empty());
  physics.set_scene(some_robots(1), in_environment(Land{}));
  physics.wait_until_done();
  EXPECT_EQ(physics.newest()->color, &material_color());
  EXPECT_TRUE(physics.newest()->details.arrows.empty());
  physics.set_scene(some_robots(1), in_environment());
  physics.wait_until_done();
  EXPECT_EQ(physics.newest()->color, &color_quantity("pressure"));
  EXPECT_TRUE(messages.take().empty());
}

}  // namespace
}  // namespace mercury
