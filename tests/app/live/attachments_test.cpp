// SPDX-License-Identifier: Apache-2.0
// Pins and springs that stay attached, actuators and neurons that are held by hand: undo, scene files, commands and the
// timeline.
#include <gmock/gmock.h>

#include <iterator>
#include <set>

#include "app/live/scene_files.h"
#include "app/live/scene_mouse.h"
#include "app/live/scene_parameters.h"
#include "app/live/scene_robots.h"
#include "app/live/scene_time.h"
#include "app/options/scene_file.h"
#include "mercury/random_voxel.h"
#include "mercury/robot_file.h"
#include "tests/app/live/live_scene_setup.h"
#include "tests/app/program.h"
#include "tests/refusal.h"
#include "tests/same_bits.h"

namespace mercury {
namespace {

using test::ids_of;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::SizeIs;

class Attachments : public test::FolderTest {
 protected:
  // Two robots, and what a scene file says of them.
  void make(LiveScene& scene) const {
    test::make_robots(scene, 2);
    const std::vector<RobotId> ids = ids_of(scene);
    scene.mouse().pin({.robot = ids[0], .index = 0, .mass = 4});
    scene.mouse().begin_perturbation({.robot = ids[1], .index = 1, .mass = 3}, 25);
    scene.mouse().move_perturbation(scene.mouse().perturbation()->at + render::Vector3(0.5f, -0.25f, 0));
    scene.mouse().attach_perturbation();
    scene.wait_until_done();
  }
  template <class Held>
  static std::vector<std::string> texts_of(const LiveScene& scene, std::vector<Held> HeldParts::*held) {
    std::vector<std::string> texts;
    const HeldParts all = held_in(scene.document());
    for (const Held& one : all.*held) texts.push_back(text_of(one));
    return texts;
  }
  static std::vector<std::string> texts_of(const LiveScene& scene) { return texts_of(scene, &HeldParts::attached); }
  // Why something is not accepted.
  template <class Read>
  static std::string refusal(const Read& read) {
    return mercury::refusal(read);
  }
  // A scene file with these lines after the first two.
  std::string scene_with(const std::string& lines) const {
    write("bad.toml", "format = \"mercury-scene\"\nversion = 1\n" + lines);
    return path("bad.toml");
  }
  // The messages of a window that opens it.
  std::vector<std::string> messages_about(LiveScene& scene, const std::string& lines) const {
    test::open_and_wait(scene, {scene_with(lines)});
    scene.frame();
    std::vector<std::string> texts;
    for (const Message& message : scene.take_messages()) texts.push_back(message.text);
    return texts;
  }
  // That a line of a scene file is refused as an option with a value.
  void expect_line_refused(const std::string& line, const std::string& option, const std::string& text) const {
    const std::string file = scene_with(line);
    EXPECT_THAT(refusal([&] { SceneFile{file}; }),
                testing::StartsWith(file + ":3: " + option + ": \"" + text + "\" is not accepted"));
  }
};

TEST_F(Attachments, UndoAndRedoTakeEachOfThemAwayAndPutItBack) {
  LiveScene scene(test::on_cpu());
  make(scene);
  const std::vector<std::string> both = texts_of(scene);
  ASSERT_THAT(both, SizeIs(2));
  EXPECT_EQ(scene.history().undo_name(), "attach a spring");
  scene.undo();
  EXPECT_THAT(texts_of(scene), ElementsAre("0:4"));
  EXPECT_EQ(scene.history().undo_name(), "pin a mass");
  test::undo_and_wait(scene);
  EXPECT_THAT(texts_of(scene), IsEmpty());
  EXPECT_THAT(scene.snapshot().perturbations, IsEmpty());
  scene.redo();
  scene.redo();
  scene.wait_until_done();
  EXPECT_EQ(texts_of(scene), both);
  EXPECT_THAT(scene.snapshot().perturbations, SizeIs(2));
  scene.mouse().remove_attachments(ids_of(scene));
  EXPECT_THAT(texts_of(scene), IsEmpty());
  scene.undo();
  EXPECT_EQ(texts_of(scene), both);
}

TEST_F(Attachments, ARobotThatComesBackHasItsPinAgain) {
  LiveScene scene(test::on_cpu());
  make(scene);
  const std::vector<std::string> both = texts_of(scene);
  scene.robots().remove({ids_of(scene)[0]});
  scene.wait_until_done();
  EXPECT_THAT(texts_of(scene), SizeIs(1));
  test::undo_and_wait(scene);
  EXPECT_EQ(texts_of(scene), both);
  EXPECT_THAT(scene.snapshot().perturbations, SizeIs(2));
}

TEST_F(Attachments, APinThatComesBackFromBeforeAResetHoldsItsMassWhereItIs) {
  test::RobotScene scene(1);
  const RobotId id = ids_of(scene)[0];
  test::step_and_wait(scene, 800);
  scene.mouse().pin({.robot = id, .index = 0, .mass = 4});
  scene.mouse().remove_attachments({id});
  test::reset_and_wait(scene);
  scene.undo();
  test::step_and_wait(scene, 200);
  EXPECT_LT(length(scene.snapshot().positions_of(0)[4] - scene.document().robots[0].body.robot->masses[4]), 1e-3f);
}

TEST_F(Attachments, ASceneFileKeepsThem) {
  LiveScene scene(test::on_cpu(Land{}));
  make(scene);
  ASSERT_TRUE(scene.files().save_scene(path("held.toml")).ok());
  EXPECT_THAT(read("held.toml"), HasSubstr("attach = [\n  \"0:4\",\n  \"1:3:"));
  LiveScene again(test::on_cpu());
  test::open_and_wait(again, {path("held.toml")});
  EXPECT_EQ(texts_of(again), texts_of(scene));
  EXPECT_THAT(again.take_messages(), IsEmpty());
  // The pin holds the mass where it starts, with the robot set down on the floor.
  const Snapshot& start = again.snapshot();
  ASSERT_EQ(start.steps, 0);
  ASSERT_THAT(start.perturbations, SizeIs(2));
  EXPECT_EQ(start.perturbations[0].target, start.positions_of(0)[4]);
}

// A file as the first version with attachments wrote it: it is read for ever.
TEST_F(Attachments, AKeptSceneFileIsRead) {
  LiveScene scene(test::on_cpu());
  test::open_and_wait(scene, {MERCURY_SCENES "/attached.toml"});
  EXPECT_THAT(texts_of(scene), ElementsAre("0:1", "1:7:0.5,-1.25,3:40"));
}

TEST_F(Attachments, ACommandNamesThem) {
  LiveScene scene(test::on_cpu());
  make(scene);
  const std::string text = scene.files().command("view").text;
  for (const std::string& one : texts_of(scene)) EXPECT_THAT(text, HasSubstr(" --attach=" + one));
  EXPECT_THAT(scene.files().command("render").notes, testing::Contains(HasSubstr("pins")));
}

TEST_F(Attachments, GoingBackBeforeAPinTakesItAwayAndUndoBringsItBack) {
  test::RobotScene scene(1);
  test::step_and_wait(scene, 100);
  const double before = scene.snapshot().time;
  test::step_and_wait(scene, 50);
  scene.mouse().pin({.robot = ids_of(scene)[0], .index = 0, .mass = 4});
  test::step_and_wait(scene, 50);
  test::seek_and_wait(scene, before);
  scene.time().go_on();
  test::step_and_wait(scene, 10);
  EXPECT_THAT(texts_of(scene), IsEmpty());
  EXPECT_THAT(scene.snapshot().perturbations, IsEmpty());
  test::undo_and_wait(scene);
  EXPECT_THAT(texts_of(scene), ElementsAre("0:4"));
  EXPECT_THAT(scene.snapshot().perturbations, SizeIs(1));
}

TEST_F(Attachments, WhatDoesNotExistIsReported) {
  save_robot(path("eel.json"), random_voxel_robot({.smallest = {1, 1, 1}, .largest = {1, 1, 1}}, 1));
  LiveScene scene(test::on_cpu());
  EXPECT_THAT(messages_about(scene, "robots = [\"eel.json\"]\nattach = [\"1:0\", \"0:8\"]\n"),
              testing::UnorderedElementsAre("attach 1:0: robot 1 is out of range, the scene has 1 robot",
                                            "attach 0:8: mass 8 is out of range, voxel-1-0 has 8"));
  EXPECT_THAT(texts_of(scene), IsEmpty());
}

// Drives by hand, of the Actuators panel.

class Drives : public Attachments {
 protected:
  Drives() {
    Robot robot = random_voxel_robot({}, 1);
    std::set<MaterialId> muscles;
    for (const Spring& spring : robot.springs)
      if (materials_of(robot)[spring.material].amplitude != 0) muscles.insert(spring.material);
    robot.actuators = {{.name = "left: \"fin\"", .materials = {*muscles.begin()}}, {.name = "tail", .materials = {}}};
    robot.actuators[1].materials.assign(std::next(muscles.begin()), muscles.end());
    save_robot(path("fins.json"), robot);
  }
  static std::vector<std::string> drives_of(const LiveScene& scene) { return texts_of(scene, &HeldParts::drives); }
};

TEST_F(Drives, ASceneFileKeepsThem) {
  LiveScene scene(test::on_cpu());
  test::open_and_wait(scene, {path("fins.json"), path("fins.json")});
  const std::vector<RobotId> ids = ids_of(scene);
  scene.parameters().drive_actuator(ids, "left: \"fin\"", -0.25f);
  scene.parameters().drive_actuator({ids[1]}, "tail", 1);
  ASSERT_TRUE(scene.files().save_scene(path("held.toml")).ok());
  LiveScene again(test::on_cpu());
  test::open_and_wait(again, {path("held.toml")});
  EXPECT_THAT(drives_of(again), ElementsAre("0:left: \"fin\":-0.25", "1:left: \"fin\":-0.25", "1:tail:1"));
  EXPECT_THAT(again.take_messages(), IsEmpty());
  // The physics has them from the first step on.
  scene.time().reset();
  for (LiveScene* one : {&scene, &again}) {
    test::step_and_wait(*one, 200);
  }
  EXPECT_TRUE(same_bits(scene.snapshot().positions.host(), again.snapshot().positions.host()));
  LiveScene free(test::on_cpu());
  test::open_and_wait(free, {path("fins.json"), path("fins.json")});
  test::step_and_wait(free, 200);
  EXPECT_FALSE(same_bits(free.snapshot().positions.host(), again.snapshot().positions.host()));
  EXPECT_THAT(again.files().command("view").text, HasSubstr(" --drive="));
}

TEST_F(Drives, WhatDoesNotExistIsReported) {
  LiveScene scene(test::on_cpu());
  EXPECT_THAT(messages_about(scene, "robots = [\"fins.json\"]\ndrive = [\"1:tail:0\", \"0:wing:1\"]\n"),
              testing::UnorderedElementsAre("drive 1:tail:0: robot 1 is out of range, the scene has 1 robot",
                                            testing::AllOf(testing::StartsWith("drive 0:wing:1: "),
                                                           testing::EndsWith(" has no actuator \"wing\""))));
  EXPECT_THAT(drives_of(scene), IsEmpty());
}

TEST_F(Drives, BadTextIsRefused) {
  for (const std::string text :
       {"", "0", "0:", "0:tail", "0::1", ":tail:1", "0:tail:2", "0:tail:nan", "0:tail:", "-1:tail:0", "a:tail:0"})
    EXPECT_THAT(refusal([&] { drive_from("--drive", text); }),
                testing::StartsWith("--drive: \"" + text + "\" is not accepted; give ROBOT:ACTUATOR:U"));
  expect_line_refused("drive = [\"0:tail:1.5\"]\n", "--drive", "0:tail:1.5");
}

// Neurons that are held by hand, of the Brain panel.

class HeldNeurons : public Attachments {
 protected:
  HeldNeurons() {
    Robot robot = random_voxel_robot({}, 9);
    const auto muscles = static_cast<std::uint32_t>(actuators_of(robot).size());
    robot.sensors = {{.kind = SensorKind::clock, .frequency = 9}};
    robot.brain.emplace().layers = {{.name = "left: a", .neurons = 2}, {.name = "motor", .neurons = muscles}};
    robot.brain->layers[0].inputs = {{.from = "senses", .weights = {0.9f, -0.4f, 0.3f, 0.7f}}};
    robot.brain->layers[1].inputs = {{.from = "left: a", .weights = std::vector<float>(2 * muscles, 0.8f)}};
    save_robot(path("thinker.json"), robot);
  }
  static std::vector<std::string> neurons_of(const LiveScene& scene) { return texts_of(scene, &HeldParts::neurons); }
  // Where the masses are after that many steps.
  static std::vector<Vec3> positions_after(LiveScene& scene, std::int64_t steps) {
    test::step_and_wait(scene, steps);
    const std::span<const Vec3> positions = scene.snapshot().positions.host();
    return {positions.begin(), positions.end()};
  }
};

TEST_F(HeldNeurons, ASceneFileKeepsThem) {
  LiveScene scene(test::on_cpu());
  test::open_and_wait(scene, {path("thinker.json"), path("thinker.json")});
  const std::vector<RobotId> ids = ids_of(scene);
  scene.parameters().clamp_neuron(ids[0], 1, 0.0f);
  scene.parameters().clamp_neuron(ids[1], 0, -0.25f);
  scene.parameters().clamp_neuron(ids[1], 3, 1e-3f);
  ASSERT_TRUE(scene.files().save_scene(path("held.toml")).ok());
  LiveScene again(test::on_cpu());
  test::open_and_wait(again, {path("held.toml")});
  EXPECT_THAT(neurons_of(again), ElementsAre("0:left: a 1:0", "1:left: a 0:-0.25", "1:motor 1:0.001"));
  EXPECT_THAT(again.take_messages(), IsEmpty());
  EXPECT_THAT(again.files().command("view").text, HasSubstr(" --neuron='0:left: a 1:0' "));
  EXPECT_THAT(again.files().command("view").notes, IsEmpty());
  EXPECT_THAT(again.files().command("render").notes,
              testing::Contains(HasSubstr("held by hand are not in the command")));
  // The physics has them from the first step on.
  scene.time().reset();
  const std::vector<Vec3> held = positions_after(again, 200);
  EXPECT_TRUE(same_bits(positions_after(scene, 200), held));
  Robot thinker = load_robot(path("thinker.json"));
  Simulation alone(again.document().configuration, std::vector{thinker, thinker});
  alone.clamp_neuron(0, 1, 0.0f);
  alone.clamp_neuron(1, 0, -0.25f);
  alone.clamp_neuron(1, 3, 1e-3f);
  alone.step(200);
  std::vector<Vec3> positions(alone.mass_count());
  alone.read_positions(positions);
  EXPECT_TRUE(same_bits(positions, held));
  Simulation free(again.document().configuration, std::vector{thinker, thinker});
  free.step(200);
  free.read_positions(positions);
  EXPECT_FALSE(same_bits(positions, held));
}

TEST_F(HeldNeurons, WhatDoesNotExistIsReported) {
  LiveScene scene(test::on_cpu());
  EXPECT_THAT(messages_about(scene,
                             "robots = [\"thinker.json\"]\n"
                             "neuron = [\"1:motor 0:0\", \"0:motor 99:1\"]\n"),
              testing::UnorderedElementsAre("neuron 1:motor 0:0: robot 1 is out of range, the scene has 1 robot",
                                            testing::AllOf(testing::StartsWith("neuron 0:motor 99:1: "),
                                                           testing::EndsWith(" has no neuron \"motor 99\""))));
  EXPECT_THAT(neurons_of(scene), IsEmpty());
}

TEST_F(HeldNeurons, BadTextIsRefused) {
  for (const std::string text : {"", "0", "0:", "0:motor 0", "0::1", ":motor 0:1", "0:motor 0:inf", "0:motor 0:nan",
                                 "0:motor 0:", "0:motor 0:1e39", "-1:motor 0:0", "a:motor 0:0"})
    EXPECT_THAT(refusal([&] { neuron_from("--neuron", text); }),
                testing::StartsWith("--neuron: \"" + text + "\" is not accepted; give ROBOT:NEURON:VALUE"));
  expect_line_refused("neuron = [\"0:motor 0:x\"]\n", "--neuron", "0:motor 0:x");
  // Other commands leave them out, and say so.
  write("held.toml",
        "format = \"mercury-scene\"\nversion = 1\nrobots = [\"thinker.json\"]\nneuron = [\"0:motor 0:0\"]\n");
  const test::Outcome run =
      test::succeeded(test::mercury({"run", path("held.toml"), "--seconds", "0.01", "--device", "cpu"}));
  EXPECT_THAT(run.messages,
              HasSubstr("held.toml: neurons that are held by hand are left out; only mercury view has them\n"));
}

TEST_F(Attachments, BadTextIsRefused) {
  for (const char* text : {"", "0", "0:", ":1", "0:65536", "-1:0", "0:1:2,3,4", "0:1:2,3:40", "0:1:2,3,4:0",
                           "0:1:2,3,4:-1", "0:1:nan,3,4:1", "0:1:2,3,4:inf", "0:1:2,3,4:1:1", "a:b"})
    EXPECT_THAT(refusal([&] { attached_mass_from("--attach", text); }), HasSubstr("ROBOT:MASS[:X,Y,Z:STIFFNESS]"))
        << text;
  expect_line_refused("attach = [\"0:1:2\"]\n", "--attach", "0:1:2");
}

}  // namespace
}  // namespace mercury
