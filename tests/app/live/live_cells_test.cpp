// SPDX-License-Identifier: Apache-2.0
// Robots that stay in their cells: picking, pulling and drawing agree on where they are.
#include <gtest/gtest.h>

#include <chrono>

#include "app/live/scene_mouse.h"
#include "tests/app/live/live_scene_setup.h"

namespace mercury {
namespace {

using render::Vector3;
using test::ids_of;
using test::make_robots;
using test::on_cpu;

// Where the center of mass of a robot is drawn.
Vector3 shown(LiveScene& scene, std::size_t robot) {
  Vector3 sum = Vector3::all(0);
  const auto positions = scene.drawn().positions_of(robot);
  for (const Vec3 p : positions) sum += Vector3(p);
  return sum / static_cast<float>(positions.size()) + scene.drawn().offsets()[robot];
}

class Cells : public testing::TestWithParam<const char*> {
 protected:
  LiveScene scene_{[] {
    LiveSceneOptions options = on_cpu(environment_named(GetParam()));
    options.view.layout = Layout::cells;
    return options;
  }()};
};

TEST_P(Cells, ARobotThatMovesStaysAndIsPickedWhereItIsDrawn) {
  make_robots(scene_, 3);
  test::step_and_wait(scene_, 1);
  const Vector3 before = shown(scene_, 1), offset = scene_.drawn().offsets()[1];
  test::step_and_wait(scene_, 2000);
  const Vector3 after = shown(scene_, 1);
  EXPECT_LT((after - before).xy().norm(), 1e-3f);
  EXPECT_GT((scene_.drawn().offsets()[1] - offset).norm(), 1e-3f) << "it has moved";
  const auto hit = scene_.mouse().pick({after + Vector3(0, 0, 50), -Vector3::unit(2)});
  ASSERT_TRUE(hit);
  EXPECT_EQ(hit->robot, ids_of(scene_)[1]);
  EXPECT_LT((hit->point - after).xy().norm(), 1e-4f);
}

TEST_P(Cells, APulledRobotFollowsTheMouseAndReturnsToItsCell) {
  make_robots(scene_, 2);
  test::step_and_wait(scene_, 300);
  const Vector3 cell = shown(scene_, 0);
  scene_.mouse().begin_perturbation({.robot = ids_of(scene_)[0], .index = 0, .mass = 1});
  scene_.frame();
  const Vector3 offset = scene_.drawn().offsets()[0];
  const Vector3 target = scene_.mouse().perturbation()->at + Vector3(0.4f, 0.2f, 0.1f);
  scene_.mouse().move_perturbation(target);
  test::step_and_wait(scene_, 300);
  EXPECT_LT((scene_.drawn().offsets()[0] - offset).norm(), 1e-5f) << "nothing is subtracted of a pull";
  EXPECT_LT((scene_.mouse().perturbation()->target - target).norm(), 1e-4f) << "the target stays under the mouse";
  EXPECT_GT((shown(scene_, 0) - cell).norm(), 1e-3f);
  scene_.mouse().end_perturbation();
  const auto deadline = std::chrono::steady_clock::now() + std::chrono::seconds(20);
  while ((shown(scene_, 0) - cell).xy().norm() > 1e-3f && std::chrono::steady_clock::now() < deadline) scene_.frame();
  EXPECT_LT((shown(scene_, 0) - cell).xy().norm(), 1e-3f);
}

INSTANTIATE_TEST_SUITE_P(Everywhere, Cells, testing::Values("ocean", "land"),
                         [](const auto& tested) { return std::string(tested.param); });

}  // namespace
}  // namespace mercury
