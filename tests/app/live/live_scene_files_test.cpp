// SPDX-License-Identifier: Apache-2.0
// Files of the window: opening and saving robots, the command that makes the scene again, session settings.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <iomanip>
#include <sstream>

#include "app/live/command_text.h"
#include "app/live/robot_saving.h"
#include "app/live/scene_files.h"
#include "app/live/scene_parameters.h"
#include "app/live/scene_robots.h"
#include "app/live/session_settings.h"
#include "app/options/robot_options.h"
#include "app/options/simulation_options.h"
#include "app/options/view_options.h"
#include "mercury/random_voxel.h"
#include "mercury/robot_file.h"
#include "tests/app/live/live_scene_setup.h"
#include "tests/app/program.h"

namespace mercury {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::SizeIs;

// A hash as the program writes it.
std::string hash_text(std::uint64_t hash) {
  std::ostringstream text;
  text << std::hex << std::setw(16) << std::setfill(static_cast<char>(48)) << hash;
  return text.str();
}

class LiveFiles : public test::FolderTest {
 protected:
  // The words that the shell makes of a line.
  static std::vector<std::string> words_of(const std::string& line) {
    const test::Outcome outcome = test::run_program("sh", {"-c", "printf '%s\\0' " + line});
    std::vector<std::string> words;
    std::istringstream text(outcome.output);
    for (std::string word; std::getline(text, word, '\0');) words.push_back(word);
    return words;
  }

  struct Parsed {
    std::vector<Robot> robots;
    Configuration configuration;
    ViewSettings view;
  };
  // The robots and settings that the options of `mercury view` make of the line.
  static Parsed parsed(const std::string& line) {
    std::vector<std::string> words = words_of(line);
    EXPECT_THAT(std::vector(words.begin(), words.begin() + 2), ElementsAre("mercury", "view"));
    words.erase(words.begin(), words.begin() + 2);
    const CommandTree tree;
    RobotOptions robots;
    SimulationOptions simulation;
    ViewOptions view;
    robots.add_to(tree.root());
    simulation.add_to(tree.root());
    view.add_to(tree.root());
    tree.parse(words);
    std::vector<Robot> copies;
    for (const auto& robot : robots.load({}).robots) copies.push_back(*robot);
    return {std::move(copies), simulation.configuration(), view.settings()};
  }
};

TEST_F(LiveFiles, OpensReadableFilesAndReportsTheOthers) {
  save_robot(path("b.json"), random_voxel_robot({}, 1, 0));
  save_robot(path("a.cbor"), random_voxel_robot({}, 1, 1));
  write("broken.json", "{");
  write("run.h5", "");
  LiveScene scene(test::on_cpu());
  test::open_and_wait(scene, {folder_, path("missing.json"), path("run.h5")});
  EXPECT_THAT(test::names_of(scene), ElementsAre("voxel-1-1", "voxel-1-0"));
  EXPECT_FALSE(scene.robots().entries()[0].unsaved);
  EXPECT_EQ(scene.robots().entries()[1].file, path("b.json"));
  const auto messages = scene.take_messages();
  ASSERT_THAT(messages, SizeIs(3));
  EXPECT_THAT(messages[0].text, HasSubstr("broken.json"));
  EXPECT_THAT(messages[1].text, HasSubstr("missing.json"));
  EXPECT_THAT(messages[2].text, HasSubstr("run.h5"));
}

TEST_F(LiveFiles, PlaysARecordingAloneAndOpensItsRobotsAtRestBesideOthers) {
  test::succeeded(test::mercury(
      {"run", "--random", "voxel:2:5", "--seconds", "0.1", "--device", "cpu", "--record", path("swim.h5"), "--quiet"}));
  LiveScene scene(test::on_cpu());
  test::open_and_wait(scene, {path("swim.h5")});
  EXPECT_TRUE(scene.snapshot().timeline.recording);
  EXPECT_THAT(test::names_of(scene), ElementsAre("voxel-5-0", "voxel-5-1"));
  EXPECT_THAT(scene.take_messages().at(0).text, HasSubstr("2 robots, recorded on"));
  scene.robots().clear();
  test::reset_and_wait(scene);
  save_robot(path("other.json"), random_voxel_robot({}, 1, 0));
  test::open_and_wait(scene, {path("swim.h5"), path("other.json")});
  EXPECT_FALSE(scene.snapshot().timeline.recording);
  EXPECT_THAT(test::names_of(scene), ElementsAre("voxel-5-0", "voxel-5-1", "voxel-1-0"));
  EXPECT_EQ(*scene.document().robots[1].body.robot, random_voxel_robot({}, 5, 1));
  EXPECT_TRUE(std::ranges::equal(scene.snapshot().positions_of(0), random_voxel_robot({}, 5, 0).masses));
  const auto messages = scene.take_messages();
  ASSERT_THAT(messages, SizeIs(1));
  EXPECT_EQ(messages[0].severity, Severity::note);
  EXPECT_THAT(messages[0].text, HasSubstr("2 robots, at rest"));
}

TEST_F(LiveFiles, DroppedFilesAreOpenedOrReported) {
  // A drop can hold files of all kinds, folders, and names with any character.
  save_robot(path("a b%20\xc3\xa9 '#?.json"), random_voxel_robot({}, 1, 0));
  std::filesystem::create_directories(folder_ / "many" / "inner");
  std::filesystem::create_directories(folder_ / "empty");
  save_robot(path("many/one.json"), random_voxel_robot({}, 1, 1));
  save_robot(path("many/two.cbor"), random_voxel_robot({}, 1, 2));
  write("picture.png", "\x89PNG");
  write("scene.toml", "dt = 0.01\n");
  write("cut.cbor", read("many/two.cbor").substr(0, 100));
  LiveScene scene(test::on_cpu());
  test::open_and_wait(scene, {path("a b%20\xc3\xa9 '#?.json"), folder_ / "many", folder_ / "empty", path("picture.png"),
                              path("scene.toml"), path("cut.cbor")});
  EXPECT_THAT(test::names_of(scene), ElementsAre("voxel-1-0", "voxel-1-1", "voxel-1-2"));
  const auto messages = scene.take_messages();
  ASSERT_THAT(messages, SizeIs(4));
  EXPECT_THAT(messages[0].text, HasSubstr("empty: the folder holds no robot"));
  EXPECT_THAT(messages[1].text, HasSubstr("picture.png"));
  EXPECT_THAT(messages[2].text, HasSubstr("scene.toml: is not a scene: format = \"mercury-scene\" is missing"));
  EXPECT_THAT(messages[3].text, HasSubstr("cut.cbor"));
  test::undo_and_wait(scene);
  EXPECT_THAT(scene.robots().entries(), IsEmpty()) << "one drop is one edit";
}

TEST_F(LiveFiles, ManyUnreadableFilesMakeFewMessages) {
  for (int i = 0; i < 30; ++i) write("broken-" + std::to_string(i) + ".json", "{");
  LiveScene scene(test::on_cpu());
  test::open_and_wait(scene, {folder_});
  const auto messages = scene.take_messages();
  ASSERT_THAT(messages, SizeIs(4));
  EXPECT_EQ(messages[3].text, "and 27 more files cannot be used");
}

TEST_F(LiveFiles, SavesTheChangedRobotAndReplacesFilesOnlyOnRequest) {
  test::RobotScene scene(2);
  const auto ids = test::ids_of(scene);
  scene.parameters().scale_materials({ids[0]}, {.stiffness = 2});
  scene.robots().rename(ids[0], "strong/one");
  EXPECT_TRUE(scene.files().save(ids[0], path("robot.json")).ok());
  EXPECT_FALSE(scene.robots().entries()[0].unsaved);
  const Robot saved = load_robot(path("robot.json"));
  EXPECT_EQ(saved.name, "strong/one");
  EXPECT_EQ(saved.materials[1].stiffness, 2 * default_materials()[1].stiffness);
  EXPECT_EQ(saved.springs, random_voxel_robot({}, 5, 0).springs);
  scene.parameters().scale_materials({ids[0]}, {});
  EXPECT_TRUE(scene.robots().entries()[0].unsaved);
  const std::string before = read("robot.json");
  const SaveResult again = scene.files().save(ids[0], path("robot.json"));
  EXPECT_EQ(again.outcome, SaveResult::Outcome::exists);
  EXPECT_EQ(read("robot.json"), before);
  EXPECT_TRUE(scene.files().save(ids[0], path("robot.json"), true).ok());
  EXPECT_NE(read("robot.json"), before);
  // All or nothing.
  write("voxel-5-1.cbor", "mine");
  const SaveResult all = scene.files().save_all(ids, folder_, RobotFormat::cbor);
  EXPECT_EQ(all.outcome, SaveResult::Outcome::exists);
  EXPECT_THAT(all.files, ElementsAre(folder_ / "voxel-5-1.cbor"));
  EXPECT_THAT(listing(), ElementsAre("robot.json", "voxel-5-1.cbor"));
  EXPECT_EQ(read("voxel-5-1.cbor"), "mine");
  EXPECT_TRUE(scene.files().save_all(ids, folder_, RobotFormat::cbor, true).ok());
  EXPECT_EQ(load_robot(path("voxel-5-1.cbor")), random_voxel_robot({}, 5, 1));
  EXPECT_EQ(scene.files().save(ids[0], path("robot.txt")).outcome, SaveResult::Outcome::failed);
  EXPECT_EQ(scene.files().save(ids[0], folder_).outcome, SaveResult::Outcome::failed);
  EXPECT_EQ(scene.files().save(99, path("x.json")).outcome, SaveResult::Outcome::failed);
}

TEST_F(LiveFiles, CommandMakesTheSameScene) {
  save_robot(path("it's $HOME.json"), random_voxel_robot({}, 1, 0));
  LiveSceneOptions options = test::on_cpu(Ocean{.density = 900.5f, .flow = {-0.1f, 0, 2}, .gravity = {0, 0, -1}});
  options.configuration.dt = 5e-4;
  options.configuration.solver = Solver::xpbd;
  options.view.color = &color_quantity("strain");
  options.view.scale = {-7.5f, 7.5f};
  options.view.shown.springs = options.view.shown.arrows.drag = options.view.shown.labels = true;
  options.view.shown.arrows.contact = true;
  options.view.theme = render::Theme::light;
  options.view.cut = render::Cut{.axis = 1, .below = true, .percent = 25.25f};
  options.view.camera.azimuth = 1.25f;
  LiveScene scene(options);
  scene.files().open({path("it's $HOME.json")});
  RandomRobots generation{.count = 3, .seed = 8, .first = 2};
  generation.values = {{"voxels", SizeRange{{3, 2, 2}, {3, 2, 2}}}, {"air", 0.125}, {"symmetry", "none"}};
  scene.robots().generate(generation);
  scene.wait_until_done();
  scene.robots().remove({test::ids_of(scene)[2]});
  generation.seed = 9;
  generation.count = 1;
  scene.robots().generate(generation);
  scene.wait_until_done();
  const CommandText command = scene.files().command();
  EXPECT_THAT(command.notes, IsEmpty());
  const Parsed same = parsed(command.text);
  ASSERT_EQ(same.robots.size(), scene.document().robots.size()) << command.text;
  for (std::size_t i = 0; i < same.robots.size(); ++i)
    EXPECT_EQ(same.robots[i], *scene.document().robots[i].body.robot) << i;
  EXPECT_EQ(same.configuration, scene.document().configuration);
  EXPECT_EQ(same.view.color, options.view.color);
  EXPECT_EQ(same.view.scale, options.view.scale);
  EXPECT_EQ(same.view.theme, options.view.theme);
  EXPECT_TRUE(same.view.shown.springs && same.view.shown.arrows.drag && same.view.shown.labels &&
              same.view.shown.clock);
  EXPECT_EQ(same.view.shown.arrows, options.view.shown.arrows);
  EXPECT_FALSE(same.view.shown.legend);
  EXPECT_EQ(same.view.cut, options.view.cut);
  EXPECT_FLOAT_EQ(same.view.camera.azimuth.value(), 1.25f);
  EXPECT_THAT(scene.files().command("render").text, HasSubstr(" -o scene.mp4"));
}

TEST_F(LiveFiles, CommandNotesWhatItCannotExpress) {
  test::RobotScene scene(2);
  scene.robots().mutate({test::ids_of(scene)[0]}, {});
  scene.wait_until_done();
  scene.parameters().scale_materials({test::ids_of(scene)[1]}, {.frequency = 2});
  EXPECT_THAT(scene.files().command().notes, SizeIs(2));
  ASSERT_TRUE(scene.files().save_all(test::ids_of(scene), folder_, RobotFormat::json).ok());
  const CommandText command = scene.files().command();
  EXPECT_THAT(command.notes, IsEmpty());
  const Parsed same = parsed(command.text);
  ASSERT_EQ(same.robots.size(), 3u);
  EXPECT_EQ(same.robots[1].materials[1].frequency, 2 * default_materials()[1].frequency);
}

TEST_F(LiveFiles, StepsGiveTheHashesOfTheRunCommand) {
  test::RobotScene scene(2);
  test::step_and_wait(scene, 700);
  const test::Outcome run =
      test::mercury({"run", "--random", "voxel:2:5", "--seconds", "0.7", "--device", "cpu", "--json", "--quiet"});
  const auto report = nlohmann::json::parse(run.output);
  Simulation same(test::on_cpu().configuration, random_voxel_robots({}, 5, 2));
  for (std::size_t i = 0; i < 2; ++i) {
    const auto positions = scene.snapshot().positions_of(i), velocities = scene.snapshot().velocities_of(i);
    same.set_state(i, positions, velocities);
    EXPECT_EQ(report["robots"][i]["hash"], hash_text(same.hash(i)));
  }
}

TEST_F(LiveFiles, SettingsAreRestoredAndInvalidFilesAreRenamed) {
  Messages messages;
  const auto file = folder_ / "mercury" / "scene.toml";
  EXPECT_EQ(load_session_settings(file, messages).generation.count, RandomRobots{}.count);
  SessionSettings settings;
  settings.pause_on_explosion = true;
  settings.folder = "/tmp/with \"quotes\" \\ and\tmore";
  settings.view.color = &color_quantity("force");
  settings.view.shown = {.skin = false, .springs = true, .scale_bar = true};
  settings.view.theme = render::Theme::light;
  settings.view.layout = Layout::race;
  settings.generation = {.kind = "nn", .count = 7, .seed = 1234567890123456789u};
  settings.generation.values = {
      {"points", std::int64_t{100}}, {"air", 0.001}, {"edge", 0.3f}, {"hidden", std::vector{8}}};
  save_session_settings(file, settings, messages);
  const SessionSettings back = load_session_settings(file, messages);
  EXPECT_THAT(messages.take(), IsEmpty());
  EXPECT_EQ(back.view.color, &color_quantity("force"));
  EXPECT_FALSE(back.view.shown.skin);
  EXPECT_TRUE(back.view.shown.springs && back.view.shown.scale_bar && back.view.shown.clock);
  EXPECT_EQ(back.view.theme, render::Theme::light);
  EXPECT_EQ(back.view.layout, Layout::race);
  EXPECT_TRUE(back.pause_on_explosion);
  EXPECT_EQ(back.folder, settings.folder);
  EXPECT_EQ(back.generation.kind, "nn");
  EXPECT_EQ(back.generation.count, 7u);
  EXPECT_EQ(back.generation.seed, settings.generation.seed);
  EXPECT_EQ(back.generation.values, settings.generation.values);
  write("mercury/scene.toml", "color = \"tartan\"\n");
  EXPECT_EQ(load_session_settings(file, messages).view.color, &material_color());
  EXPECT_THAT(messages.take(), SizeIs(1));
  EXPECT_EQ(read("mercury/scene.toml.broken"), "color = \"tartan\"\n");
  save_session_settings(folder_ / "mercury" / "scene.toml.broken" / "x.toml", settings, messages);
  EXPECT_THAT(messages.take(), SizeIs(1));
}

TEST(FileName, HasNoCharacterThatFileNamesMustNotHave) {
  EXPECT_EQ(file_name_of("a/b\\c"), "a_b_c");
  EXPECT_EQ(file_name_of("../.."), "_..");
  EXPECT_EQ(file_name_of(""), "robot");
  EXPECT_EQ(file_name_of("-rf"), "rf");
}

}  // namespace
}  // namespace mercury
