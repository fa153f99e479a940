// SPDX-License-Identifier: Apache-2.0
// The window's scene on every backend. The CUDA cases are skipped on a machine without a GPU.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>

#include "app/live/measurements.h"
#include "app/live/picking.h"
#include "app/live/replay_log.h"
#include "app/live/scene_mouse.h"
#include "app/live/scene_parameters.h"
#include "app/live/scene_robots.h"
#include "app/live/scene_time.h"
#include "app/recording/repro.h"
#include "mercury/random_voxel.h"
#include "tests/app/live/live_scene_setup.h"
#include "tests/nap.h"
#include "tests/sim/backend.h"

namespace mercury {
namespace {

using testing::SizeIs;

class LiveOn : public BackendTest {
 protected:
  LiveSceneOptions options(Environment environment = Ocean{}) const {
    return {.configuration = {.environment = environment, .device = device()}};
  }
};
INSTANTIATE_TEST_SUITE_P(All, LiveOn, every_device, BackendTest::name);

TEST_P(LiveOn, StepsAndEditsGiveTheStatesOfTheSimulation) {
  for (const Environment& environment : {Environment(Ocean{}), Environment(Land{})}) {
    test::RobotScene scene(3, options(environment));
    test::step_and_wait(scene, 130);
    const auto ids = test::ids_of(scene);
    scene.parameters().scale_materials({ids[2]}, {.stiffness = 1.25f, .frequency = 2});
    scene.robots().remove({ids[0]});
    test::step_and_wait(scene, 70);
    Simulation simulation(options(environment).configuration, random_voxel_robots({}, 5, 3));
    simulation.step(130);
    const auto table = scene.parameters().materials(ids[2]);
    for (std::size_t id = 1; id < table.size(); ++id)
      simulation.set_material(2, static_cast<MaterialId>(id), table[id]);
    simulation.step(70);
    for (const std::size_t robot : {1u, 2u}) {
      const State state = simulation.state(robot);
      EXPECT_TRUE(std::ranges::equal(scene.snapshot().positions_of(robot - 1), state.positions)) << robot;
      EXPECT_TRUE(std::ranges::equal(scene.snapshot().velocities_of(robot - 1), state.velocities)) << robot;
    }
    test::undo_and_wait(scene);
    EXPECT_EQ(scene.snapshot().robots->size(), 3u);
    EXPECT_THAT(scene.take_messages(), testing::IsEmpty());
  }
}

TEST_P(LiveOn, PlayingAtUnlimitedSpeedGivesTheStatesOfTheSimulation) {
  test::RobotScene scene(4, options());
  scene.time().set_speed(unlimited_speed);
  scene.time().play();
  std::uint64_t pictures = 0;
  const auto samples = [&] { return scene.measurements().series(test::ids_of(scene)[0]).times.size(); };
  for (std::int64_t seen = -1; scene.snapshot().steps < 4000 || pictures < 5 || samples() < 3; test::nap()) {
    scene.frame();
    pictures += scene.snapshot().steps != seen;
    seen = scene.snapshot().steps;
    if (scene.snapshot().playing && pictures > 3) {
      EXPECT_TRUE(scene.snapshot().velocities.empty()) << "velocities are read only on request";
    }
  }
  scene.time().pause();
  scene.wait_until_done();
  Simulation simulation(options().configuration, random_voxel_robots({}, 5, 4));
  simulation.step(scene.snapshot().steps);
  for (std::size_t robot = 0; robot < 4; ++robot) {
    EXPECT_TRUE(std::ranges::equal(scene.snapshot().positions_of(robot), simulation.positions(robot)));
    EXPECT_FALSE(scene.snapshot().velocities_of(robot).empty()) << "a paused scene has velocities";
  }
  // Samples were dropped, but the others are evenly spaced.
  const Series series = scene.measurements().series(test::ids_of(scene)[0]);
  ASSERT_EQ(series.times.size(), series.samples.size());
  ASSERT_GE(series.times.size(), 3u);
  for (std::size_t i = 2; i < series.times.size(); ++i)
    EXPECT_NEAR(series.times[i] - series.times[i - 1], series.times[1] - series.times[0], 1e-9) << i;
}

TEST_P(LiveOn, ExplosionIsMarkedAndComesBackWithUndo) {
  test::RobotScene scene(2, options());
  const RobotId robot = test::ids_of(scene)[1];
  test::step_and_wait(scene, 50);
  scene.mouse().begin_perturbation({.robot = robot, .index = 1, .mass = 2}, 30);
  scene.mouse().move_perturbation(scene.mouse().perturbation()->at + render::Vector3(0.3f, 0, 0));
  test::step_and_wait(scene, 50);
  Configuration coarse = scene.document().configuration;
  coarse.dt = 0.4;
  scene.parameters().set_configuration(coarse);
  test::step_and_wait(scene, 300);
  const auto exploded = scene.exploded();
  const auto found = std::ranges::find(exploded, robot, &ExplodedRobot::robot);
  ASSERT_NE(found, exploded.end());
  ASSERT_TRUE(found->spring);
  const std::size_t index = found->index;
  const std::vector<Vec3> frozen(scene.snapshot().positions_of(index).begin(),
                                 scene.snapshot().positions_of(index).end());
  scene.robots().remove({robot});
  scene.wait_until_done();
  test::undo_and_wait(scene);
  const auto back = scene.exploded();
  const auto again = std::ranges::find(back, robot, &ExplodedRobot::robot);
  ASSERT_NE(again, back.end());
  EXPECT_EQ(again->time, found->time);
  EXPECT_EQ(again->spring->index, found->spring->index);
  EXPECT_TRUE(std::ranges::equal(scene.snapshot().positions_of(again->index), frozen));
}

TEST_P(LiveOn, APushAddsItsVelocityToAllRobotsOnce) {
  test::RobotScene scene(2, options());
  test::step_and_wait(scene, 50);
  const std::vector<Telemetry> before = scene.snapshot().telemetry;
  EXPECT_FALSE(scene.parameters().push({NAN, 0, 0}));
  ASSERT_TRUE(scene.parameters().push({3, 0, -1}));
  EXPECT_EQ(scene.history().undo_name(), "change parameters");
  test::step_and_wait(scene, 3);
  const std::vector<Telemetry> after = scene.snapshot().telemetry;
  // What forces did meanwhile is little: no robot reaches 0.3 m/s in three steps.
  for (std::size_t i = 0; i < 2; ++i) {
    EXPECT_NEAR(after[i].velocity.x - before[i].velocity.x, 3, 0.3) << i;
    EXPECT_NEAR(after[i].velocity.z - before[i].velocity.z, -1, 0.3) << i;
  }
}

TEST_P(LiveOn, ReproGivesTheSameStateFromItsStart) {
  Robot robot = random_voxel_robot({}, 5, 0);
  Simulation simulation({.device = device()}, std::span(&robot, 1));
  simulation.step(120);
  Repro repro{.robot = robot,
              .configuration = simulation.configuration(),
              .clock = simulation.clock(),
              .state = simulation.state(0)};
  Material material = default_materials()[3];
  material.stiffness *= 2;
  std::vector<Material> table(default_materials().begin(), default_materials().end());
  table[3] = material;
  Configuration changed = simulation.configuration();
  changed.dt = 6e-4;
  repro.perturbations = {{.mass = 1, .target = {0, 1, 0}, .stiffness = 25}};
  repro.changes = {{.step = 150, .materials = table},
                   {.step = 170, .configuration = changed},
                   {.step = 200, .perturbations = std::vector<Perturbation>{}}};
  repro.last_step = 400;
  simulation.set_perturbations(repro.perturbations);
  simulation.step(30);
  simulation.set_material(0, 3, material);
  simulation.step(20);
  simulation.configure(changed);
  simulation.step(30);
  simulation.set_perturbations({});
  simulation.step(200);
  const Repro read = parse_repro(serialize_repro(repro));
  Simulation same = start_of(read, device());
  ReproChanges changes(read);
  while (same.steps() < 400) {
    changes.apply(same);
    same.step(std::min<std::int64_t>(400, changes.next_step()) - same.steps());
  }
  EXPECT_EQ(same.hash(0), simulation.hash(0));
  EXPECT_EQ(same.time(), simulation.time());
}

}  // namespace
}  // namespace mercury
