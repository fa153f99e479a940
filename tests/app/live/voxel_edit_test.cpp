// SPDX-License-Identifier: Apache-2.0
// Editing bodies voxel by voxel, and what an edited robot takes over of its motion.
#include "app/live/voxel_edit.h"

#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>

#include "app/live/picking.h"
#include "app/live/population.h"
#include "app/live/scene_robots.h"
#include "mercury/error.h"
#include "mercury/random_voxel.h"
#include "tests/app/live/live_scene_setup.h"
#include "tests/refusal.h"

namespace mercury {
namespace {

Robot block(int x, int y, int z) {
  return make_voxel_robot(VoxelGrid(x, y, z, 3), {.name = "block", .environment = "ocean"});
}

// The face whose outside lies in this direction.
VoxelSide side_toward(const Robot& robot, Vec3 direction) {
  for (std::size_t face = 0; face < robot.faces.size(); ++face) {
    const VoxelSide side = voxel_side_of(robot, face).value();
    const Vec3 step{static_cast<float>(side.beside[0] - side.voxel[0]),
                    static_cast<float>(side.beside[1] - side.voxel[1]),
                    static_cast<float>(side.beside[2] - side.voxel[2])};
    if (step == direction) return side;
  }
  ADD_FAILURE() << "no such face";
  return {};
}

bool has_mass_at(const Robot& robot, Vec3 place) {
  return std::ranges::any_of(robot.masses, [&](Vec3 mass) { return length(mass - place) < 1e-5f; });
}

TEST(VoxelEdit, EveryFaceHasAVoxelBehindItAndAirBeforeIt) {
  const Robot robot = random_voxel_robot({}, 7, 0);
  const VoxelGrid grid = voxel_grid_of(robot).value();
  for (std::size_t face = 0; face < robot.faces.size(); ++face) {
    const auto side = voxel_side_of(robot, face);
    ASSERT_TRUE(side) << face;
    EXPECT_NE(grid.at(side->voxel[0], side->voxel[1], side->voxel[2]), air);
    EXPECT_EQ(grid.at(side->beside[0], side->beside[1], side->beside[2]), air);
    int steps = 0;
    for (std::size_t axis = 0; axis < 3; ++axis) steps += std::abs(side->beside[axis] - side->voxel[axis]);
    EXPECT_EQ(steps, 1);
  }
}

TEST(VoxelEdit, AVoxelBesideTheGridAddsFourMassesAndMovesNone) {
  const Robot before = block(3, 2, 2);
  const Robot after = with_voxel(before, side_toward(before, {1, 0, 0}), {.tool = VoxelTool::add, .material = 5});
  EXPECT_EQ(after.masses.size(), before.masses.size() + 4);
  for (const Vec3 mass : before.masses) EXPECT_TRUE(has_mass_at(after, mass));
  EXPECT_EQ(after.name, "block");
  const VoxelGrid grid = voxel_grid_of(after).value();
  EXPECT_EQ(std::ranges::count(grid.cells, MaterialId{5}), 1);
  EXPECT_EQ(std::ranges::count(grid.cells, MaterialId{3}), 12);
}

TEST(VoxelEdit, MirroredVoxelsAppearOnBothSides) {
  const Robot before = block(3, 2, 2);
  const Robot after =
      with_voxel(before, side_toward(before, {1, 0, 0}), {.tool = VoxelTool::add, .material = 5, .mirror = Mirror::x});
  EXPECT_EQ(after.masses.size(), before.masses.size() + 8);
  for (const Vec3 mass : after.masses) EXPECT_TRUE(has_mass_at(after, {-mass.x, mass.y, mass.z}));
}

TEST(VoxelEdit, EditedRobotsKeepTheirMassesAndFixedPoints) {
  Robot before = block(2, 2, 2);
  before.mass.assign(before.masses.size(), 0.5f);
  before.fixed = {3};
  const Robot after = with_voxel(before, side_toward(before, {0, 0, 1}), {.tool = VoxelTool::add, .material = 3});
  EXPECT_EQ(after.mass, std::vector<float>(after.masses.size(), 0.5f));
  ASSERT_EQ(after.fixed.size(), 1u);
  EXPECT_EQ(after.masses[after.fixed[0]], before.masses[3]);
}

TEST(VoxelEdit, TakingAwayWhatWasAddedGivesTheBodyBack) {
  const Robot before = block(2, 2, 2);
  const Robot larger = with_voxel(before, side_toward(before, {0, 0, 1}), {.tool = VoxelTool::add, .material = 3});
  std::size_t highest = 0;
  for (std::size_t face = 0; face < larger.faces.size(); ++face)
    if (voxel_side_of(larger, face)->voxel[2] > voxel_side_of(larger, highest)->voxel[2]) highest = face;
  const Robot again = with_voxel(larger, voxel_side_of(larger, highest).value(), {.tool = VoxelTool::remove});
  EXPECT_EQ(again.masses, before.masses);
  EXPECT_EQ(again.springs, before.springs);
  EXPECT_EQ(again.faces, before.faces);
}

TEST(VoxelEdit, PaintChangesMaterialsAlone) {
  const Robot before = block(2, 2, 2);
  const Robot after = with_voxel(before, side_toward(before, {0, 1, 0}), {.tool = VoxelTool::paint, .material = 22});
  EXPECT_EQ(after.masses, before.masses);
  EXPECT_EQ(std::ranges::count(voxel_grid_of(after)->cells, MaterialId{22}), 1);
}

TEST(VoxelEdit, WhatCannotBeEditedIsRefusedWithAReason) {
  const Robot one = block(1, 1, 1);
  const VoxelSide side = side_toward(one, {1, 0, 0});
  const auto problem = [&](const Robot& robot, const VoxelEdit& edit) {
    return refusal([&] { with_voxel(robot, side, edit); });
  };
  EXPECT_EQ(problem(one, {.tool = VoxelTool::remove}), "block: would have no voxel left");
  EXPECT_THAT(problem(one, {.tool = VoxelTool::paint, .material = 40}), testing::HasSubstr("give 1 to 22"));
  Robot other = one;
  other.origin.clear();
  EXPECT_THAT(problem(other, {.tool = VoxelTool::paint}), testing::HasSubstr("only voxel robots can be edited"));
  EXPECT_FALSE(voxel_side_of(other, 0));
  EXPECT_FALSE(voxel_side_of(one, one.faces.size()));
}

TEST(CarriedState, MassesGoOnWhereTheyAreAndNewOnesMoveWithTheirNeighbors) {
  const Robot before = block(1, 1, 1);
  const Robot after = with_voxel(before, side_toward(before, {1, 0, 0}), {.tool = VoxelTool::add, .material = 3});
  // The body has moved by (1, 2, 3) m and goes at 4 m/s.
  State state{.positions = before.masses, .velocities = std::vector<Vec3>(before.masses.size(), Vec3{4, 0, 0})};
  for (Vec3& position : state.positions) position += Vec3{1, 2, 3};
  const State carried = carried_state(before, state, after).value();
  ASSERT_EQ(carried.positions.size(), 12u);
  for (std::size_t i = 0; i < carried.positions.size(); ++i) {
    EXPECT_LT(length(carried.positions[i] - after.masses[i] - Vec3{1, 2, 3}), 1e-5f);
    EXPECT_EQ(carried.velocities[i], (Vec3{4, 0, 0}));
  }
  state.exploded = true;
  EXPECT_FALSE(carried_state(before, state, after));
}

TEST(LiveScene, AnEditedBodyGoesOnWhereItIsAndUndoBringsTheOldOneBack) {
  test::RobotScene scene(1);
  const RobotId id = test::ids_of(scene).front();
  test::step_and_wait(scene, 300);
  const auto before = scene.hold_snapshot();
  const Robot robot = *scene.document().robots[0].body.robot;
  ASSERT_TRUE(scene.robots().has_voxels(id));
  const VoxelSide side = scene.robots().voxel_side({.robot = id, .face = 0}).value();
  EXPECT_TRUE(scene.robots().edit_voxel(id, side, {.tool = VoxelTool::add, .material = 1}));
  EXPECT_EQ(scene.history().undo_name(), "add a voxel");
  scene.wait_until_done();
  const Robot edited = *scene.document().robots[0].body.robot;
  ASSERT_GT(edited.masses.size(), robot.masses.size());
  for (std::size_t i = 0; i < robot.masses.size(); ++i) {
    const auto same =
        std::ranges::find_if(edited.masses, [&](Vec3 mass) { return length(mass - robot.masses[i]) < 1e-5f; });
    ASSERT_NE(same, edited.masses.end());
    EXPECT_EQ(scene.snapshot().positions_of(0)[static_cast<std::size_t>(same - edited.masses.begin())],
              before->positions_of(0)[i]);
  }
  test::undo_and_wait(scene);
  EXPECT_EQ(*scene.document().robots[0].body.robot, robot);
  for (std::size_t i = 0; i < robot.masses.size(); ++i)
    EXPECT_LT(length(scene.snapshot().positions_of(0)[i] - before->positions_of(0)[i]), 1e-5f);
}

}  // namespace
}  // namespace mercury
