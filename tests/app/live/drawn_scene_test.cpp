// SPDX-License-Identifier: Apache-2.0
// The scene that the window draws: bodies, colors and shapes after edits.
#include <gtest/gtest.h>

#include <cmath>

#include "app/live/scene_parameters.h"
#include "app/live/scene_robots.h"
#include "app/live/scene_time.h"
#include "tests/app/live/live_scene_setup.h"

namespace mercury {
namespace {

using test::ids_of;

TEST(DrawnScene, BodiesChangeOnlyWhenRobotsChange) {
  test::RobotScene scene(2);
  const auto revision = scene.drawn().bodies_revision();
  scene.time().step(10);
  ViewSettings view = scene.view();
  view.color = &color_quantity("strain");
  view.shown.arrows.drag = view.shown.legend = view.shown.labels = true;
  scene.set_view(view);
  scene.parameters().scale_materials(ids_of(scene), {.stiffness = 2});
  scene.wait_until_done();
  EXPECT_EQ(scene.drawn().bodies_revision(), revision);
  const render::Scene& drawn = scene.drawn().scene();
  EXPECT_EQ(drawn.positions.size(), 3 * scene.snapshot().positions.size());
  EXPECT_EQ(drawn.mass_values.size(), scene.snapshot().positions.size());
  EXPECT_FALSE(drawn.arrows.empty());
  ASSERT_TRUE(drawn.legend);
  EXPECT_EQ(drawn.legend->title, "strain");
  EXPECT_EQ(drawn.labels.size(), 2u);
  scene.robots().duplicate({ids_of(scene)[0]});
  scene.wait_until_done();
  EXPECT_GT(scene.drawn().bodies_revision(), revision);
  EXPECT_EQ(scene.drawn().bounds().size(), 3u);
}

TEST(DrawnScene, EachRobotOfALargeGroupGlowsByItsOwnMaterials) {
  test::RobotScene scene(120);
  const auto ids = ids_of(scene);
  test::step_and_wait(scene, 300);
  const auto revision = scene.drawn().bodies_revision();
  const render::Scene& drawn = scene.drawn().scene();
  // From the muscle law: +1 where the muscle is shortest.
  const auto activation = [&](std::size_t robot, MaterialId id) {
    return drawn.materials[drawn.placements[robot].first_material + id].activation;
  };
  const auto expected = [&](const Material& material) {
    return -std::sin(static_cast<double>(material.frequency) * scene.snapshot().time +
                     static_cast<double>(material.phase));
  };
  scene.parameters().scale_materials({ids[7], ids[110]}, {.frequency = 3});
  scene.parameters().scale_materials({ids[60]}, {.phase = 1});
  scene.wait_until_done();
  for (const std::size_t robot : {0u, 7u, 60u, 110u, 119u})
    for (const MaterialId id : {MaterialId{1}, MaterialId{6}, MaterialId{20}})
      EXPECT_NEAR(activation(robot, id), expected(scene.parameters().materials(ids[robot])[id]), 1e-5)
          << robot << ", material " << int{id};
  EXPECT_EQ(drawn.placements[7].first_material, drawn.placements[110].first_material) << "equal tables are stored once";
  EXPECT_EQ(drawn.placements[0].first_material, drawn.placements[119].first_material);
  const auto materials = drawn.materials.size();
  for (int i = 0; i < 50; ++i) {
    scene.parameters().scale_materials(
        {ids[7]}, {.stiffness = 1 + 0.01f * static_cast<float>(i), .phase = 0.01f * static_cast<float>(i)});
    scene.wait_until_done();
  }
  EXPECT_LE(drawn.materials.size(), materials + 2 * 254) << "the tables of a slider's old values are dropped";
  scene.parameters().reset_materials(ids);
  scene.wait_until_done();
  for (const std::size_t robot : {7u, 60u, 110u})
    EXPECT_NEAR(activation(robot, 5), expected(default_materials()[5]), 1e-5);
  EXPECT_EQ(scene.drawn().bodies_revision(), revision) << "the bodies did not change";
}

TEST(DrawnScene, EditReusesTheShapesOfRobotsThatStay) {
  test::RobotScene scene(3);
  const auto before = scene.hold_snapshot();
  scene.robots().duplicate({ids_of(scene)[1]});
  scene.robots().remove({ids_of(scene)[0]});
  scene.wait_until_done();
  const LiveRobots& after = *scene.snapshot().robots;
  ASSERT_EQ(after.shapes.size(), 3u);
  EXPECT_EQ(after.shapes[0], before->robots->shapes[1]);
  EXPECT_EQ(after.shapes[1], before->robots->shapes[2]);
  EXPECT_EQ(after.shapes[2], before->robots->shapes[1]) << "a copy shares the shape of its original";
  EXPECT_EQ(after.bodies->mass_offsets.back(), scene.snapshot().positions.size());
}

}  // namespace
}  // namespace mercury
