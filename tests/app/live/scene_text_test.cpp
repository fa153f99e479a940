// SPDX-License-Identifier: Apache-2.0
// A scene that the window saves comes back as it was: every setting, every robot.
#include "app/live/scene_text.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "app/live/command_text.h"
#include "app/live/robot_saving.h"
#include "app/live/scene_files.h"
#include "app/live/scene_parameters.h"
#include "app/live/scene_robots.h"
#include "app/options/scene_file.h"
#include "mercury/random_voxel.h"
#include "mercury/robot_file.h"
#include "tests/app/live/live_scene_setup.h"
#include "tests/app/program.h"

namespace mercury {
namespace {

using test::ids_of;
using test::names_of;
using testing::ElementsAre;
using testing::HasSubstr;

class SceneText : public test::FolderTest {
 protected:
  SceneText() {
    save_robot(path("eel.json"), random_voxel_robot({.smallest = {2, 1, 1}, .largest = {2, 1, 1}}, 1));
    document_.body = {.id = 1, .name = "eel"};
    document_.body.robot = std::make_shared<const Robot>(load_robot(path("eel.json")));
  }
  // Writes a scene of one robot and reads it.
  SceneFile again(const Configuration& configuration, const ViewSettings& view) {
    const SceneOutput files = scene_files(path("a.toml"), {{&document_, path("eel.json")}}, configuration, view);
    EXPECT_EQ(files.files.size(), 1u);
    write("a.toml", files.files.back().content);
    return SceneFile(path("a.toml"));
  }
  static Configuration configuration_of(const SceneFile& scene) {
    std::vector<std::string> notes;
    return scene.configuration({}, notes);
  }

  DocumentRobot document_;
};

// No value is a default, so that one that is not written or read makes the test fail.
TEST_F(SceneText, EveryParameterOfEveryEnvironmentComesBack) {
  const Environment environments[] = {Ocean{998.2f, 1.1f, 0.3f, 0.4f, {0.1f, 0.2f, 0.3f}, {0.4f, 0.5f, -0.6f}, 1.7f},
                                      OceanSimple{0.7f, {0.1f, 0.2f, 0.3f}, {0.4f, 0.5f, -0.6f}, 1.7f},
                                      Land{{0.1f, 0, -1.62f}, 0.55f, false, 123, 150},
                                      Environment{.water = FaceDrag{998.2f, 1.1f, 0.3f, 0.4f, {0.1f, 0.2f, 0.3f}},
                                                  .ground = Plane{0.55f},
                                                  .contacts = Contacts{false, 123},
                                                  .gravity = {0.4f, 0.5f, -0.6f},
                                                  .stiffness_scale = 1.7f}};
  for (const Environment& environment : environments) {
    const Configuration configuration{
        .dt = 1.25e-3, .damping = 0.3, .solver = Solver::xpbd, .environment = environment};
    EXPECT_EQ(configuration_of(again(configuration, {})), configuration) << name_of(environment);
  }
}

TEST_F(SceneText, WhereItIsComputedIsNotPartOfAScene) {
  Configuration configuration;
  configuration.device = {.kind = DeviceKind::cpu, .threads = 2};
  EXPECT_EQ(configuration_of(again(configuration, {})), Configuration{});
  EXPECT_THAT(read("a.toml"), testing::Not(HasSubstr("device")));
}

std::vector<ViewSettings> views() {
  std::vector<ViewSettings> all(1);
  const auto add = [&](const auto& change) {
    ViewSettings view;
    view.color = &color_quantity("strain");
    view.shown.legend = true;
    change(view);
    all.push_back(view);
  };
  add([](ViewSettings& v) { v.scale = {-0.25f, 0.1f}; });
  add([](ViewSettings& v) { v.colormap = render::Colormap::cividis; });
  add([](ViewSettings& v) { v.log_scale = true; });
  for (bool Shown::*what : {&Shown::skin, &Shown::springs, &Shown::masses, &Shown::path, &Shown::labels,
                            &Shown::captions, &Shown::legend, &Shown::clock, &Shown::scale_bar})
    add([&](ViewSettings& v) { v.shown.*what = !(v.shown.*what); });
  for (bool ArrowKinds::*what :
       {&ArrowKinds::drag, &ArrowKinds::lift, &ArrowKinds::velocity, &ArrowKinds::gravity, &ArrowKinds::contact})
    add([&](ViewSettings& v) { v.shown.arrows.*what = true; });
  add([](ViewSettings& v) { v.shown.arrows = {.drag = true, .length = 2.5f, .density = 0.25f, .threshold = 0.125f}; });
  add([](ViewSettings& v) { v.shown = {.skin = false, .clock = false}; });
  add([](ViewSettings& v) { v.theme = render::Theme::light; });
  add([](ViewSettings& v) { v.plain = v.smooth = true; });
  add([](ViewSettings& v) { v.footprints = false; });
  add([](ViewSettings& v) { v.cut = render::Cut{.axis = 1, .below = true, .percent = 33.3f}; });
  add([](ViewSettings& v) { v.cut = render::Cut{.axis = 2, .shift = -0.2f}; });
  add([](ViewSettings& v) { v.grid = Grid{3, 2}; });
  add([](ViewSettings& v) {
    v.layout = Layout::race;
    v.shown.labels = v.shown.path = true;
    v.camera = {.azimuth = 0.3f, .elevation = 0.7f, .field_of_view = 0.2f};
  });
  add([](ViewSettings& v) { v.caption = "two \"fast\" eels\nén, #2"; });
  add([](ViewSettings& v) {
    v.camera = {.mode = CameraMode::still,
                .azimuth = -2.1f,
                .elevation = 0.123456f,
                .zoom = 1.5f,
                .field_of_view = 0.55f,
                .target = render::Vector3(1, -1e-5f, 0.3f),
                .distance = 12.25f};
  });
  add([](ViewSettings& v) { v.camera = {.mode = CameraMode::follow, .robot = "the \\ eel"}; });
  add([](ViewSettings& v) { v.camera = {.mode = CameraMode::turntable, .azimuth = 1, .period = 7.5}; });
  add([](ViewSettings& v) { v.camera = {.mode = CameraMode::top}; });
  return all;
}

void expect_same_camera(const CameraPlan& a, const CameraPlan& b) {
  EXPECT_EQ(a.mode, b.mode);
  EXPECT_EQ(a.robot, b.robot);
  EXPECT_EQ(a.azimuth, b.azimuth);
  EXPECT_EQ(a.elevation, b.elevation);
  EXPECT_EQ(a.zoom, b.zoom);
  EXPECT_EQ(a.field_of_view, b.field_of_view);
  EXPECT_EQ(a.period, b.period);
  EXPECT_EQ(a.target, b.target);
  EXPECT_EQ(a.distance, b.distance);
}

TEST_F(SceneText, EveryLookAndCameraComesBack) {
  int index = 0;
  for (const ViewSettings& view : views()) {
    SCOPED_TRACE(index++);
    const ViewSettings found = again({}, view).view();
    EXPECT_EQ(options_of(found), options_of(view)) << read("a.toml");
    expect_same_camera(found.camera, view.camera);
  }
}

TEST_F(SceneText, RobotsComeBackInTheirOrder) {
  LiveScene scene(test::on_cpu(Land{.friction = 0.4f}));
  test::open_and_wait(scene, {path("eel.json")});
  scene.robots().generate({.count = 2, .seed = 4});  // a changed robot follows, so a seed cannot name them
  scene.wait_until_done();
  Robot mine = random_voxel_robot({}, 9);
  mine.name = "mine / 1";
  scene.robots().add({mine});
  scene.robots().generate({.count = 3, .seed = 7, .first = 2});
  scene.robots().generate({.count = 2, .seed = 7, .first = 5});
  scene.wait_until_done();
  Material stiff = scene.parameters().materials(ids_of(scene)[1])[1];
  stiff.stiffness = 77;
  stiff.half_wave = true;
  ASSERT_TRUE(scene.parameters().set_material({ids_of(scene)[1]}, 1, stiff));
  ViewSettings view = scene.view();
  view.color = &color_quantity("strain");
  view.camera = {.mode = CameraMode::still, .azimuth = 0.5f, .target = render::Vector3(1, 2, 3), .distance = 4};
  scene.set_view(view);
  std::filesystem::create_directory(folder_ / "scenes");
  const std::string file = path("scenes/both.toml");
  const SaveResult saved = scene.files().save_scene(file);
  ASSERT_TRUE(saved.ok()) << saved.message;
  EXPECT_THAT(listing("scenes"), ElementsAre("both-robots", "both.toml"));
  EXPECT_EQ(listing("scenes/both-robots").size(), 3u);
  EXPECT_THAT(read("scenes/both.toml"), HasSubstr("\"../eel.json\""));
  EXPECT_THAT(read("scenes/both.toml"), HasSubstr("\"voxel:5:7:2\""));
  for (const RobotEntry& robot : scene.robots().entries())
    EXPECT_TRUE(!robot.unsaved || robot.name.starts_with("voxel-7")) << robot.name;

  LiveScene other(test::on_cpu());
  test::make_robots(other, 1, 20);
  test::open_and_wait(other, {file});
  EXPECT_EQ(names_of(other), names_of(scene));
  EXPECT_EQ(other.document().configuration, scene.document().configuration);
  EXPECT_EQ(other.view().color->key, "strain");
  expect_same_camera(other.files().take_camera().value_or(CameraPlan{}), view.camera);
  EXPECT_FALSE(other.files().take_camera());
  for (std::size_t i = 0; i < names_of(scene).size(); ++i) {
    const Robot a = whole_robot(scene.document().robots[i]), b = whole_robot(other.document().robots[i]);
    EXPECT_EQ(a.masses, b.masses) << i;
    EXPECT_EQ(a.springs, b.springs) << i;
    EXPECT_TRUE(std::ranges::equal(materials_of(a), materials_of(b))) << i;
  }

  // Saved again, it names the files that are there now; the scene itself is not replaced without a question.
  EXPECT_EQ(scene.files().save_scene(file).outcome, SaveResult::Outcome::exists);
  ASSERT_TRUE(scene.files().save_scene(file, true).ok());
  EXPECT_EQ(listing("scenes/both-robots").size(), 3u);
  EXPECT_EQ(scene.files().save_scene(path("scenes")).outcome, SaveResult::Outcome::failed) << "a folder";
}

TEST_F(SceneText, OneThatCannotBeUsedIsReportedInOneLineAndChangesNothing) {
  test::RobotScene scene(1);
  write("bad.toml", "format = \"mercury-scene\"\nversion = 1\nrobots = [\"missing.json\"]\n");
  write("worse.toml", "format = \"mercury-scene\"\nversion = 1\ndt = -1\n");
  for (const char* name : {"bad.toml", "worse.toml"}) {
    test::open_and_wait(scene, {path(name)});
    const std::vector<Message> messages = scene.take_messages();
    ASSERT_EQ(messages.size(), 1u);
    EXPECT_EQ(messages[0].severity, Severity::error);
    EXPECT_EQ(messages[0].text.find('\n'), std::string::npos);
    EXPECT_EQ(names_of(scene).size(), 1u);
  }
  scene.robots().clear();
  EXPECT_EQ(scene.files().save_scene(path("none.toml")).outcome, SaveResult::Outcome::failed);
}

}  // namespace
}  // namespace mercury
