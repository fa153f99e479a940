// SPDX-License-Identifier: Apache-2.0
// The window's scene: robots, edits, undo, selection, mouse.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "app/live/scene_files.h"
#include "app/live/scene_mouse.h"
#include "app/live/scene_parameters.h"
#include "app/live/scene_robots.h"
#include "app/live/scene_selection.h"
#include "app/live/scene_time.h"
#include "mercury/random_voxel.h"
#include "mercury/robot_file.h"
#include "mercury/samples.h"
#include "tests/app/live/live_scene_setup.h"

namespace mercury {
namespace {

using test::ids_of;
using test::names_of;
using test::on_cpu;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::SizeIs;

TEST(LiveScene, RandomRobotsAreThoseOfTheirSeed) {
  test::RobotScene scene(3);
  EXPECT_THAT(names_of(scene), ElementsAre("voxel-5-0", "voxel-5-1", "voxel-5-2"));
  EXPECT_EQ(*scene.document().robots[1].body.robot, random_voxel_robot({}, 5, 1));
  EXPECT_EQ(scene.snapshot().robots->size(), 3u);
  EXPECT_TRUE(scene.robots().entries()[0].unsaved);
  EXPECT_THAT(scene.take_messages(), IsEmpty());
}

TEST(LiveScene, UndoAndRedoRestoreTheStateBitForBit) {
  test::RobotScene scene(3);
  test::step_and_wait(scene, 50);
  const auto before = scene.hold_snapshot();
  scene.robots().remove({ids_of(scene)[1]});
  scene.wait_until_done();
  EXPECT_EQ(scene.snapshot().robots->size(), 2u);
  EXPECT_EQ(scene.history().undo_name(), "remove 1 robot");
  test::undo_and_wait(scene);
  EXPECT_TRUE(std::ranges::equal(scene.snapshot().positions.host(), before->positions.host()));
  EXPECT_EQ(scene.snapshot().velocities, before->velocities);
  EXPECT_EQ(scene.snapshot().time, before->time);
  scene.redo();
  scene.wait_until_done();
  EXPECT_THAT(names_of(scene), ElementsAre("voxel-5-0", "voxel-5-2"));
  scene.undo();
  test::undo_and_wait(scene);
  EXPECT_THAT(scene.robots().entries(), IsEmpty());
  EXPECT_FALSE(scene.history().can_undo());
  EXPECT_TRUE(scene.history().can_redo());
}

TEST(LiveScene, DuplicateStartsAtRestWithItsOwnName) {
  test::RobotScene scene(1);
  test::step_and_wait(scene, 80);
  scene.robots().duplicate(ids_of(scene));
  scene.wait_until_done();
  EXPECT_THAT(names_of(scene), ElementsAre("voxel-5-0", "voxel-5-0-2"));
  const Robot& robot = *scene.document().robots[0].body.robot;
  EXPECT_TRUE(std::ranges::equal(scene.snapshot().positions_of(1), robot.masses));
  EXPECT_FALSE(std::ranges::equal(scene.snapshot().positions_of(0), robot.masses));
}

TEST(LiveScene, ChildOfASymmetricRobotIsSymmetricAndDiffersFromIt) {
  test::RobotScene scene(1);
  const MutationRequest mutation{.strength = 10, .seed = 3};
  scene.robots().mutate(ids_of(scene), mutation);
  scene.wait_until_done();
  ASSERT_THAT(scene.robots().entries(), SizeIs(2));
  const VoxelGrid parent = voxel_grid_of(*scene.document().robots[0].body.robot).value();
  const VoxelGrid child = voxel_grid_of(*scene.document().robots[1].body.robot).value();
  EXPECT_NE(parent.cells, child.cells);
  for (int z = 0; z < child.nz; ++z)
    for (int y = 0; y < child.ny; ++y)
      for (int x = 0; x < child.nx; ++x) ASSERT_EQ(child.at(x, y, z), child.at(x, child.ny - 1 - y, z));
  // With replace, the child takes the place of its parent.
  scene.robots().mutate({ids_of(scene)[0]}, mutation, true);
  scene.wait_until_done();
  ASSERT_THAT(scene.robots().entries(), SizeIs(2));
  EXPECT_EQ(names_of(scene)[1], "voxel-5-0-child");
  EXPECT_EQ(scene.history().undo_name(), "mutate 1 robot");
}

TEST(LiveScene, RobotWithoutAGeneratorCannotBeMutated) {
  LiveScene scene(on_cpu());
  scene.robots().add({Robot{.name = "point", .masses = {{0, 0, 0}}}});
  const auto ids = ids_of(scene);
  scene.robots().mutate(ids, {});
  scene.wait_until_done();
  EXPECT_THAT(scene.robots().entries(), SizeIs(1));
  const auto messages = scene.take_messages();
  ASSERT_THAT(messages, SizeIs(1));
  EXPECT_THAT(messages[0].text, HasSubstr("point: cannot be mutated"));
}

TEST(LiveScene, InvalidRobotIsReportedAndLeftOut) {
  LiveScene scene(on_cpu());
  scene.robots().add({Robot{.name = "empty"}, Robot{.name = "point", .masses = {{0, 0, 0}}}});
  scene.wait_until_done();
  EXPECT_THAT(names_of(scene), ElementsAre("point"));
  EXPECT_THAT(scene.take_messages(), SizeIs(1));
}

TEST(LiveScene, SavedRobotBecomesUnsavedWhenItChanges) {
  LiveScene scene(on_cpu());
  scene.robots().add({random_voxel_robot({}, 1, 0)}, false);
  scene.robots().add({random_voxel_robot({}, 1, 1)});
  EXPECT_FALSE(scene.robots().entries()[0].unsaved);
  EXPECT_TRUE(scene.robots().entries()[1].unsaved);
  EXPECT_EQ(scene.robots().entries()[0].file, "");
  EXPECT_THAT(scene.files().command().notes, SizeIs(2));
  scene.parameters().scale_materials({ids_of(scene)[0]}, {.stiffness = 2});
  EXPECT_TRUE(scene.robots().entries()[0].unsaved);
  scene.undo();
  EXPECT_FALSE(scene.robots().entries()[0].unsaved);
}

TEST(LiveScene, ParametersActAtOnceAndADragIsOneUndo) {
  test::RobotScene scene(1);
  Configuration configuration = scene.document().configuration;
  for (int i = 1; i <= 10; ++i) {
    configuration.damping = 0.1 * i;
    EXPECT_TRUE(scene.parameters().set_configuration(configuration));
  }
  scene.end_edit();
  configuration.solver = Solver::xpbd;
  EXPECT_TRUE(scene.parameters().set_configuration(configuration));
  scene.wait_until_done();
  EXPECT_EQ(scene.snapshot().configuration, configuration);
  scene.undo();
  EXPECT_EQ(scene.document().configuration.solver, Solver::force);
  EXPECT_DOUBLE_EQ(scene.document().configuration.damping, 1.0);
  scene.undo();
  EXPECT_EQ(scene.document().configuration.damping, Configuration{}.damping);
  configuration.dt = -1;
  EXPECT_FALSE(scene.parameters().set_configuration(configuration));
  const auto messages = scene.take_messages();
  ASSERT_THAT(messages, SizeIs(1));
  EXPECT_EQ(messages[0].text, "dt: -1 is not accepted; give a finite number > 0 s");
  EXPECT_EQ(scene.document().configuration.damping, Configuration{}.damping);
}

TEST(LiveScene, TunedMaterialsActAsInTheSimulation) {
  test::RobotScene scene(2);
  const auto ids = ids_of(scene);
  scene.parameters().scale_materials({ids[0]}, {.stiffness = 2, .amplitude = 0.5f, .frequency = 3, .phase = 0.1f});
  Material material = scene.parameters().materials(ids[0])[1];
  EXPECT_EQ(material.stiffness, 2 * default_materials()[1].stiffness);
  material.phase = 1;
  EXPECT_TRUE(scene.parameters().set_material({ids[0]}, 1, material));
  test::step_and_wait(scene, 100);
  Simulation simulation(on_cpu().configuration, random_voxel_robots({}, 5, 2));
  const auto table = scene.parameters().materials(ids[0]);
  for (std::size_t id = 1; id < table.size(); ++id) simulation.set_material(0, static_cast<MaterialId>(id), table[id]);
  simulation.step(100);
  EXPECT_TRUE(std::ranges::equal(scene.snapshot().positions_of(0), simulation.positions(0)));
  EXPECT_TRUE(std::ranges::equal(scene.snapshot().positions_of(1), simulation.positions(1)));
  EXPECT_FALSE(scene.parameters().set_material(ids, 1, {.stiffness = -1}));
  EXPECT_FALSE(scene.parameters().scale_materials(ids, {.stiffness = NAN}));
  EXPECT_THAT(scene.take_messages(), SizeIs(2));
  scene.parameters().reset_materials(ids);
  EXPECT_FALSE(scene.robots().entries()[0].tuned);
  EXPECT_TRUE(std::ranges::equal(scene.parameters().materials(ids[0]), default_materials()));
}

TEST(LiveScene, WatchedBrainIsThatOfTheSimulation) {
  const Robot hunter = load_robot(sample_or_path("sample:hunter"));
  LiveSceneOptions options = on_cpu();
  options.configuration.environment.target = {-2, 3, 0};
  test::RobotScene scene(1, options);
  scene.robots().add({hunter});
  test::step_and_wait(scene, 150);
  EXPECT_FALSE(scene.snapshot().brain.has_value());
  scene.watch_brain(ids_of(scene)[1]);
  scene.wait_until_done();
  ASSERT_TRUE(scene.snapshot().brain.has_value());
  Simulation simulation(scene.document().configuration, {&hunter, 1});
  simulation.step(150);
  const BrainState expected = simulation.brain_state(0);
  EXPECT_EQ(scene.snapshot().brain->robot, ids_of(scene)[1]);
  EXPECT_EQ(scene.snapshot().brain->neurons, expected.neurons);
  EXPECT_TRUE(std::ranges::equal(scene.snapshot().brain->senses,
                                 std::span(expected.senses).first(brain_layout(hunter).senses.size())));
  scene.watch_brain(ids_of(scene)[0]);  // it has none
  scene.wait_until_done();
  EXPECT_FALSE(scene.snapshot().brain.has_value());
}

TEST(LiveScene, SelectionKeepsItsOrderAndForgetsRemovedRobots) {
  test::RobotScene scene(3);
  const auto ids = ids_of(scene);
  scene.selection().select(ids[2]);
  scene.selection().select(ids[0], false);
  EXPECT_THAT(scene.selection().robots(), ElementsAre(ids[0], ids[2]));
  EXPECT_EQ(scene.selection().current(), ids[0]);
  scene.robots().remove({ids[0]});
  scene.frame();
  EXPECT_EQ(scene.selection().current(), ids[2]);
  scene.selection().toggle(ids[2]);
  EXPECT_EQ(scene.selection().current(), std::nullopt);
  scene.selection().select_all();
  EXPECT_THAT(scene.selection().robots(), ElementsAre(ids[1], ids[2]));
  scene.wait_until_done();
  EXPECT_TRUE(scene.drawn().scene().placements[0].selected);
}

TEST(LiveScene, SpeedStepsAreOneTwoFiveUpToUnlimited) {
  LiveScene scene(on_cpu());
  scene.time().change_speed(1);
  EXPECT_EQ(scene.time().speed(), 2);
  scene.time().change_speed(-3);
  EXPECT_EQ(scene.time().speed(), 0.2);
  scene.time().change_speed(100);
  EXPECT_EQ(scene.time().speed(), unlimited_speed);
  scene.time().change_speed(-1);
  EXPECT_EQ(scene.time().speed(), 100);
  scene.time().set_speed(0);
  EXPECT_EQ(scene.time().speed(), 1e-3);
  scene.time().set_speed(NAN);
  EXPECT_EQ(scene.time().speed(), 1e-3);
}

TEST(LiveScene, PerturbationShowsTheForceOfItsSpring) {
  test::RobotScene scene(4);
  const std::size_t last = 3;
  const RobotId id = ids_of(scene)[last];
  const render::Vector3 offset = scene.drawn().offsets()[last];
  EXPECT_GT(offset.norm(), 0.1f) << "the robots stand side by side";
  scene.mouse().begin_perturbation({.robot = id, .index = last, .mass = 2}, 30);
  ASSERT_TRUE(scene.mouse().perturbation());
  EXPECT_EQ(scene.mouse().perturbation()->force, 0);
  const render::Vector3 target = scene.mouse().perturbation()->at + render::Vector3(0, 0.3f, 0.4f);
  scene.mouse().move_perturbation(target);
  EXPECT_NEAR(scene.mouse().perturbation()->force, 30 * 0.5f, 1e-4f);
  EXPECT_LT((scene.mouse().perturbation()->target - target).norm(), 1e-6f);
  // The perturbation is the only outer force but for the drag of the water, which is small after two steps.
  test::step_and_wait(scene, 2);
  Vec3 momentum;
  for (const Vec3 v : scene.snapshot().velocities_of(last)) momentum += v;
  EXPECT_NEAR(momentum.y, 2e-3f * 30 * 0.3f, 1e-3f);
  EXPECT_NEAR(momentum.z, 2e-3f * 30 * 0.4f, 1e-3f);
  scene.robots().remove({id});
  scene.frame();
  EXPECT_FALSE(scene.mouse().perturbation());
}

TEST(EditHistory, ForgetsTheOldestEditsWhenMemoryIsFull) {
  EditHistory history(10);
  SceneDocument document;
  const auto robot = [](std::size_t springs) {
    return DocumentRobot{
        .body = {.robot = std::make_shared<const Robot>(Robot{.springs = std::vector<Spring>(springs)})}};
  };
  for (int i = 0; i < 20; ++i) {
    history.before_change(document, "make");
    document.robots = {robot(4)};
  }
  int undone = 0;
  for (; history.can_undo(); ++undone) history.undo(document);
  EXPECT_GE(undone, 2);
  EXPECT_LE(undone, 4);
  // Edits that keep their robots cost no memory.
  EditHistory slider(10);
  for (int i = 0; i < 300; ++i) slider.before_change(document, "change");
  for (undone = 0; slider.can_undo(); ++undone) slider.undo(document);
  EXPECT_EQ(undone, 200);
}

TEST(LiveScene, ClosesWhilePlayingAndWorkingInTheBackground) {
  LiveScene scene(on_cpu());
  scene.robots().generate({.count = 200});
  scene.time().set_speed(unlimited_speed);
  scene.time().play();
  scene.frame();
}

}  // namespace
}  // namespace mercury
