// SPDX-License-Identifier: Apache-2.0
// Robots that are put into another environment, springs that stay attached, and children of two.
#include <gmock/gmock.h>

#include <algorithm>

#include "app/live/scene_mouse.h"
#include "app/live/scene_parameters.h"
#include "app/live/scene_robots.h"
#include "mercury/generator.h"
#include "tests/app/live/live_scene_setup.h"

namespace mercury {
namespace {

using test::ids_of;

float lowest(const Snapshot& snapshot, std::size_t robot) {
  float z = 1e30f;
  for (const Vec3 position : snapshot.positions_of(robot)) z = std::min(z, position.z);
  return z;
}

Configuration on_land(const LiveScene& scene, Solver solver) {
  Configuration configuration = scene.document().configuration;
  configuration.environment = Land{};
  configuration.solver = solver;
  return configuration;
}

TEST(LiveScene, RobotsThatComeToLandAreSetDownAtRestAndUndoTakesThemBack) {
  test::RobotScene scene(3);
  test::step_and_wait(scene, 400);
  const auto swimming = scene.hold_snapshot();
  EXPECT_TRUE(scene.parameters().set_configuration(on_land(scene, Solver::xpbd)));
  EXPECT_EQ(scene.history().undo_name(), "move to land");
  scene.wait_until_done();
  for (std::size_t i = 0; i < 3; ++i) EXPECT_NEAR(lowest(scene.snapshot(), i), 0, 1e-5);
  for (const Vec3 velocity : scene.snapshot().velocities) EXPECT_EQ(velocity, Vec3{});
  test::step_and_wait(scene, 200);
  const auto crawling = scene.hold_snapshot();
  test::undo_and_wait(scene);
  EXPECT_EQ(scene.document().configuration.solver, Solver::force);
  EXPECT_TRUE(std::ranges::equal(scene.snapshot().positions.host(), swimming->positions.host()));
  EXPECT_EQ(scene.snapshot().velocities, swimming->velocities);
  scene.redo();
  scene.wait_until_done();
  EXPECT_TRUE(std::ranges::equal(scene.snapshot().positions.host(), crawling->positions.host()));
  EXPECT_EQ(scene.snapshot().velocities, crawling->velocities);
}

// Springs of 5,000 N/m and more explode on land, where they are 200 times as stiff: dt must stay below 2 / sqrt(k n).
TEST(LiveScene, UndoOfAMoveToLandMakesExplodedRobotsWhole) {
  test::RobotScene scene(2);
  scene.parameters().scale_materials(ids_of(scene), {.stiffness = 100});
  scene.end_edit();
  test::step_and_wait(scene, 100);
  const auto swimming = scene.hold_snapshot();
  ASSERT_FALSE(scene.robots().entries()[0].exploded);
  scene.parameters().set_configuration(on_land(scene, Solver::force));
  test::step_and_wait(scene, 100);
  ASSERT_TRUE(scene.robots().entries()[0].exploded);
  test::undo_and_wait(scene);
  EXPECT_FALSE(scene.robots().entries()[0].exploded);
  EXPECT_THAT(scene.exploded(), testing::IsEmpty());
  EXPECT_TRUE(std::ranges::equal(scene.snapshot().positions.host(), swimming->positions.host()));
  // With XPBD they survive, and an explosion after that is seen again.
  scene.parameters().set_configuration(on_land(scene, Solver::xpbd));
  test::step_and_wait(scene, 500);
  EXPECT_FALSE(scene.robots().entries()[0].exploded);
}

TEST(LiveScene, APinHoldsAMassAndFollowsAReset) {
  test::RobotScene scene(1);
  const RobotId id = ids_of(scene).front();
  test::step_and_wait(scene, 500);
  const Vec3 place = scene.snapshot().positions_of(0)[4];
  scene.mouse().pin({.robot = id, .index = 0, .mass = 4});
  EXPECT_TRUE(scene.mouse().has_attachments({id}));
  test::step_and_wait(scene, 1500);
  // Forces on a mass are some 10 N, the pin is 0.2 / dt^2 = 200 kN/m.
  EXPECT_LT(length(scene.snapshot().positions_of(0)[4] - place), 1e-3f);
  test::reset_and_wait(scene);
  scene.frame();
  test::step_and_wait(scene, 1500);
  EXPECT_LT(length(scene.snapshot().positions_of(0)[4] - scene.document().robots[0].body.robot->masses[4]), 1e-3f);
  scene.mouse().remove_attachments({id});
  EXPECT_FALSE(scene.mouse().has_attachments({id}));
  EXPECT_THAT(scene.mouse().attachments(), testing::IsEmpty());
}

TEST(LiveScene, AnAttachedSpringGoesOnPulling) {
  test::RobotScene scene(1);
  const RobotId id = ids_of(scene).front();
  const Vec3 start = scene.snapshot().telemetry[0].center_of_mass;
  scene.mouse().begin_perturbation({.robot = id, .index = 0, .mass = 4});
  const PerturbationDetails pull = scene.mouse().perturbation().value();
  scene.mouse().move_perturbation(pull.at + render::Vector3(2, 0, 0));
  scene.mouse().attach_perturbation();
  EXPECT_FALSE(scene.mouse().perturbation());
  ASSERT_THAT(scene.mouse().attachments(), testing::SizeIs(1));
  test::step_and_wait(scene, 3000);
  // Drag opposes it, and a spring of rest length 0 that is not in the way ends at its target.
  EXPECT_GT(scene.snapshot().telemetry[0].center_of_mass.x - start.x, 0.5f);
  scene.robots().remove({id});
  scene.wait_until_done();
  EXPECT_THAT(scene.mouse().attachments(), testing::IsEmpty());
}

TEST(LiveScene, AChildOfTwoIsTheCrossoverOfItsSeed) {
  test::RobotScene scene(2);
  const std::vector<RobotId> parents = ids_of(scene);
  scene.robots().breed(parents[0], parents[1], 9);
  scene.wait_until_done();
  ASSERT_THAT(scene.robots().entries(), testing::SizeIs(3));
  const Robot child =
      cross_robots(*scene.document().robots[0].body.robot, *scene.document().robots[1].body.robot, 9, "voxel-5-0-x");
  EXPECT_EQ(scene.robots().entries()[2].name, "voxel-5-0-x");
  EXPECT_EQ(scene.document().robots[2].body.robot->masses, child.masses);
  EXPECT_EQ(scene.document().robots[2].body.robot->springs, child.springs);
  scene.undo();
  EXPECT_THAT(scene.robots().entries(), testing::SizeIs(2));
}

}  // namespace
}  // namespace mercury
