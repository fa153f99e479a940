// SPDX-License-Identifier: Apache-2.0
// Explosions in the window's scene: which spring is shown, where, and that undo restores it.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <cmath>

#include "app/live/picking.h"
#include "app/live/scene_parameters.h"
#include "app/live/scene_robots.h"
#include "app/live/scene_selection.h"
#include "app/live/scene_time.h"
#include "mercury/random_voxel.h"
#include "tests/app/live/live_scene_setup.h"

namespace mercury {
namespace {

using test::ids_of;
using test::names_of;
using testing::ElementsAre;
using testing::IsEmpty;
using testing::SizeIs;

constexpr float length = 0.1f;  // of springs at rest [m]

// Empty space without damping.
LiveSceneOptions in_space() {
  LiveSceneOptions options = test::on_cpu(OceanSimple{.point_drag = 0});
  options.configuration.damping = 0;
  return options;
}

// All springs are of material 1, which is stable, except one of material 2, whose k dt^2 makes the force solver
// unstable.
Robot with_unstable_spring(const std::string& name, std::vector<Vec3> masses,
                           const std::vector<std::array<std::uint16_t, 2>>& ends, std::size_t unstable,
                           float stiffness = 4e6f) {
  Robot robot{.name = name, .masses = std::move(masses)};
  robot.materials = {{}, {.stiffness = 50}, {.stiffness = stiffness}};
  robot.material_names = {"air", "stable", "unstable"};
  for (const auto& [a, b] : ends)
    robot.springs.push_back({a, b, static_cast<MaterialId>(robot.springs.size() == unstable ? 2 : 1), length});
  return robot;
}

// Masses on a line, 1 % farther apart than the rest length of their springs.
Robot chain(std::size_t unstable, float stiffness = 4e6f) {
  std::vector<Vec3> masses;
  std::vector<std::array<std::uint16_t, 2>> ends;
  for (std::uint16_t i = 0; i < 8; ++i) {
    masses.push_back({1.01f * length * static_cast<float>(i), 0, 0});
    if (i > 0) ends.push_back({static_cast<std::uint16_t>(i - 1), i});
  }
  return with_unstable_spring("chain", masses, ends, unstable, stiffness);
}

void explode(LiveScene& scene) { test::step_and_wait(scene, 200); }

TEST(LiveExplosion, UnstableSpringAmongSeparatePairsIsShown) {
  LiveScene scene(in_space());
  std::vector<Vec3> masses;
  for (int pair = 0; pair < 3; ++pair)
    for (int end = 0; end < 2; ++end)
      masses.push_back({1.02f * length * static_cast<float>(end), static_cast<float>(pair), 0});
  scene.robots().add({with_unstable_spring("pairs", masses, {{0, 1}, {2, 3}, {5, 4}}, 2)});
  explode(scene);
  const auto exploded = scene.exploded();
  ASSERT_THAT(exploded, SizeIs(1));
  EXPECT_EQ(exploded[0].name, "pairs");
  EXPECT_EQ(exploded[0].robot, ids_of(scene)[0]);
  EXPECT_EQ(exploded[0].time, scene.snapshot().telemetry[0].exploded_at);
  ASSERT_TRUE(exploded[0].spring);
  const CulpritSpring& spring = *exploded[0].spring;
  EXPECT_EQ(spring.index, 2u);
  EXPECT_EQ(spring.a, 5);
  EXPECT_EQ(spring.b, 4);
  EXPECT_EQ(spring.figures.material_name, "unstable");
  EXPECT_GT(spring.figures.length, 16 * length);
  const auto positions = scene.snapshot().positions_of(0);
  EXPECT_FLOAT_EQ(mercury::length(positions[4] - positions[5]), spring.figures.length);
  // The body that is shown in its place has the size that it had when it was built, and is where the robot was last.
  const render::Bounds& box = exploded[0].box;
  EXPECT_LT(box.high.x - box.low.x, 1.3f * length);
  EXPECT_LT(box.high.y - box.low.y, 2.6f);
  EXPECT_LT((box.center() - scene.drawn().cell_center(0)).norm(), 0.1f);
  const std::vector<Vec3>& built = exploded[0].body->masses;
  for (const std::uint16_t mass : {spring.a, spring.b})
    for (int axis = 0; axis < 3; ++axis) {
      const float at = (render::Vector3(built[mass]) + exploded[0].offset)[axis];
      EXPECT_GT(at, box.low[axis] - 1e-5f);
      EXPECT_LT(at, box.high[axis] + 1e-5f);
    }
}

// Algorithm 1 in double precision, until a spring is longer than sixteen times the longest rest length.
struct Expected {
  std::size_t spring;
  std::vector<double> positions;
};
Expected expected_explosion(const Robot& robot, double dt) {
  std::vector<double> x, v(robot.masses.size());
  for (const Vec3 mass : robot.masses) x.push_back(static_cast<double>(mass.x));
  for (int step = 0; step < 200; ++step) {
    std::vector<double> force(x.size());
    std::size_t longest = robot.springs.size();
    double most = 16.0 * static_cast<double>(length);
    for (std::size_t i = 0; i < robot.springs.size(); ++i) {
      const Spring& spring = robot.springs[i];
      const double d = x[spring.b] - x[spring.a];
      if (std::abs(d) > most) {
        most = std::abs(d);
        longest = i;
      }
      const double k = static_cast<double>(robot.materials[spring.material].stiffness);
      const double pull = k * (std::abs(d) - static_cast<double>(length)) * (d < 0 ? -1 : 1);
      force[spring.a] += pull;
      force[spring.b] -= pull;
    }
    if (longest < robot.springs.size()) return {longest, x};
    for (std::size_t i = 0; i < x.size(); ++i) {
      v[i] += dt * force[i];
      x[i] += dt * v[i];
    }
  }
  return {robot.springs.size(), x};
}

TEST(LiveExplosion, SpringAndPlaceInAChainAreThoseOfASimpleLoop) {
  for (const std::size_t unstable : {0u, 3u, 6u}) {
    LiveScene scene(in_space());
    const Robot robot = chain(unstable);
    scene.robots().add({robot});
    explode(scene);
    const auto exploded = scene.exploded();
    ASSERT_THAT(exploded, SizeIs(1));
    ASSERT_TRUE(exploded[0].spring);
    const Expected loop = expected_explosion(robot, scene.document().configuration.dt);
    ASSERT_LT(loop.spring, robot.springs.size());
    const CulpritSpring& spring = *exploded[0].spring;
    EXPECT_EQ(spring.index, loop.spring) << unstable;
    const float expected = static_cast<float>(loop.positions[spring.b] - loop.positions[spring.a]);
    EXPECT_NEAR(spring.figures.length, std::abs(expected), 0.02f * std::abs(expected)) << unstable;
  }
}

TEST(LiveExplosion, SeveralExplosionsAreSortedByTime) {
  LiveScene scene(in_space());
  // The less stiff the spring, the later the explosion.
  scene.robots().add({chain(2, 2.2e6f), chain(4, 1), chain(5, 2e7f), chain(1, 6e6f)});
  explode(scene);
  const auto exploded = scene.exploded();
  ASSERT_THAT(exploded, SizeIs(3));
  const auto ids = ids_of(scene);
  EXPECT_EQ(exploded[0].robot, ids[2]);
  EXPECT_EQ(exploded[1].robot, ids[3]);
  EXPECT_EQ(exploded[2].robot, ids[0]);
  EXPECT_LT(exploded[0].time, exploded[2].time);
  for (const ExplodedRobot& one : exploded) {
    ASSERT_TRUE(one.spring);
    EXPECT_TRUE(scene.drawn().scene().placements[one.index].faulty);
  }
  scene.selection().set_hidden(ids[3], true);
  EXPECT_THAT(scene.exploded(), SizeIs(2));
}

TEST(LiveExplosion, ComesBackWithUndoAtOnceAndDoesNotPause) {
  LiveScene scene(in_space());
  scene.time().pause_on_explosion(false);
  scene.robots().add({chain(3), chain(1, 1)});
  explode(scene);
  const auto before = scene.exploded();
  ASSERT_THAT(before, SizeIs(1));
  const auto ids = ids_of(scene);
  scene.time().pause_on_explosion(true);
  scene.robots().remove({ids[0]});
  scene.wait_until_done();
  EXPECT_THAT(scene.exploded(), IsEmpty());
  // A change of the time step in between does not change the explosion.
  Configuration finer = scene.document().configuration;
  finer.dt /= 8;
  ASSERT_TRUE(scene.parameters().set_configuration(finer));
  scene.end_edit();
  scene.undo();
  test::undo_and_wait(scene);
  const auto stops = scene.snapshot().stops;
  const auto after = scene.exploded();
  ASSERT_THAT(after, SizeIs(1)) << "no step was made since";
  EXPECT_EQ(after[0].robot, ids[0]);
  EXPECT_EQ(after[0].time, before[0].time);
  ASSERT_TRUE(after[0].spring);
  EXPECT_EQ(after[0].spring->index, before[0].spring->index);
  EXPECT_EQ(after[0].box.center(), before[0].box.center());
  EXPECT_TRUE(scene.drawn().scene().placements[after[0].index].faulty);
  EXPECT_TRUE(scene.robots().entries()[0].exploded);
  EXPECT_EQ(stops, 0u) << "it did not explode again";
  scene.redo();
  scene.wait_until_done();
  EXPECT_THAT(scene.exploded(), IsEmpty());
  test::undo_and_wait(scene);
  EXPECT_THAT(scene.exploded(), SizeIs(1));
  // A copy is a new robot at rest. A reset removes explosions.
  scene.robots().duplicate({ids[0]});
  scene.wait_until_done();
  EXPECT_THAT(scene.exploded(), SizeIs(1));
  test::reset_and_wait(scene);
  EXPECT_THAT(scene.exploded(), IsEmpty());
  EXPECT_FALSE(scene.drawn().scene().placements[0].faulty);
}

}  // namespace
}  // namespace mercury
