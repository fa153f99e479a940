// SPDX-License-Identifier: Apache-2.0
// Robots of the window that begin as the first trial of a run does, around the target: after a reset, on the timeline,
// in scenes, videos and exports.
#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "app/live/scene_comparison.h"
#include "app/live/scene_files.h"
#include "app/live/scene_parameters.h"
#include "app/live/scene_robots.h"
#include "app/live/scene_time.h"
#include "app/options/scene_file.h"
#include "app/recording/trajectory_reader.h"
#include "tests/app/live/live_scene_setup.h"
#include "tests/app/program.h"
#include "tests/refusal.h"
#include "tests/same_bits.h"
#include "tests/sim/backend.h"

namespace mercury {
namespace {

using test::ids_of;
using testing::Each;
using testing::ElementsAre;
using testing::FloatNear;
using testing::HasSubstr;
using testing::IsEmpty;

constexpr Vec3 target{0.3f, 0.2f, 0};

TrialStart around(double radius, std::uint64_t seed = 3) {
  TrialStart start{.seed = seed};
  start.trials.target_radius = radius;
  start.trials.turned = true;
  return start;
}

std::vector<Vec3> positions_of(const LiveScene& scene) {
  const std::span<const Vec3> positions = scene.snapshot().positions.host();
  return {positions.begin(), positions.end()};
}

// How far each robot's center of mass is from the target along the horizon [m].
std::vector<float> distances_in(const LiveScene& scene, Vec3 from = target) {
  std::vector<float> distances;
  for (const Telemetry& robot : scene.snapshot().telemetry)
    distances.push_back(std::hypot(robot.center_of_mass.x - from.x, robot.center_of_mass.y - from.y));
  return distances;
}

class StartOn : public BackendTest {
 protected:
  LiveSceneOptions options(const TrialStart& start, Environment environment = Ocean{}) const {
    environment.target = target;
    return {.configuration = {.environment = environment, .device = device()}, .start = start};
  }
};
INSTANTIATE_TEST_SUITE_P(All, StartOn, every_device, BackendTest::name);

TEST_P(StartOn, RobotsAreAroundTheTargetAtTheStartAndAfterAReset) {
  for (const Environment& environment : {Environment(Ocean{}), Environment(Land{})}) {
    LiveScene scene(options(around(0.6), environment));
    test::make_robots(scene, 2);
    const std::vector<Vec3> start = positions_of(scene);
    EXPECT_THAT(distances_in(scene), Each(FloatNear(0.6f, 1e-5f)));
    if (has_ground(environment)) {
      EXPECT_NEAR(std::ranges::min(start, {}, &Vec3::z).z, 0, 1e-6);
    }
    test::step_and_wait(scene, 150);
    EXPECT_FALSE(same_bits(positions_of(scene), start));
    test::reset_and_wait(scene);
    EXPECT_EQ(scene.snapshot().steps, 0);
    EXPECT_TRUE(same_bits(positions_of(scene), start));
  }
}

// What the timeline shows is what was played.
TEST_P(StartOn, TheTimelineShowsTheStartAndAllAfterIt) {
  LiveScene scene(options(around(0.6)));
  test::make_robots(scene, 2);
  std::vector<std::vector<Vec3>> played{positions_of(scene)};
  for (int k = 0; k < 3; ++k) {
    test::step_and_wait(scene, 100);
    played.push_back(positions_of(scene));
  }
  for (const std::size_t k : {std::size_t{0}, std::size_t{2}, std::size_t{1}, std::size_t{3}}) {
    test::seek_and_wait(scene, 0.1 * static_cast<double>(k));
    EXPECT_EQ(scene.snapshot().steps, 100 * static_cast<std::int64_t>(k));
    EXPECT_TRUE(same_bits(positions_of(scene), played[k])) << k;
  }
  scene.time().reset();
  test::step_and_wait(scene, 200);
  EXPECT_TRUE(same_bits(positions_of(scene), played[2]));
}

TEST_P(StartOn, AChangeActsAtOnceAtTimeZeroAndElseAfterAReset) {
  test::RobotScene scene(1, options({}));
  const std::vector<Vec3> rest = positions_of(scene);
  ASSERT_TRUE(scene.parameters().set_start(around(0.6)));
  scene.wait_until_done();
  EXPECT_THAT(distances_in(scene), ElementsAre(FloatNear(0.6f, 1e-5f)));
  EXPECT_EQ(scene.history().undo_name(), "change the start");
  test::undo_and_wait(scene);
  EXPECT_TRUE(same_bits(positions_of(scene), rest));
  scene.redo();
  test::step_and_wait(scene, 100);
  const std::vector<Vec3> later = positions_of(scene);
  ASSERT_TRUE(scene.parameters().set_start(around(0.9)));
  scene.wait_until_done();
  EXPECT_TRUE(same_bits(positions_of(scene), later));
  test::reset_and_wait(scene);
  EXPECT_THAT(distances_in(scene), ElementsAre(FloatNear(0.9f, 1e-5f)));
  TrialStart bad = around(0.6);
  bad.trials.target_spread = 2;
  EXPECT_FALSE(scene.parameters().set_start(bad));
  EXPECT_EQ(scene.document().start, around(0.9));
}

// The target goes where the user drags it; the robots go on where they are, and begin around its new place.
TEST_P(StartOn, ATargetThatIsMovedByHandStaysThere) {
  LiveScene scene(options(around(0.6)));
  test::make_robots(scene, 1);
  const std::vector<Vec3> start = positions_of(scene);
  Configuration moved = scene.document().configuration;
  moved.environment.target = {-2, 1, 0};
  ASSERT_TRUE(scene.parameters().set_configuration(moved));
  scene.wait_until_done();
  EXPECT_TRUE(same_bits(positions_of(scene), start));
  scene.comparison().set_second(SideDifference("environment=land"));
  scene.wait_until_done();
  const Vec3 apart = scene.snapshot().second->positions.host()[0] - start[0];
  EXPECT_EQ(apart.x, 0);
  EXPECT_EQ(apart.y, 0);
  test::step_and_wait(scene, 100);
  test::reset_and_wait(scene);
  EXPECT_EQ(scene.document().configuration.environment.target, (Vec3{-2, 1, 0}));
  EXPECT_THAT(distances_in(scene, {-2, 1, 0}), ElementsAre(FloatNear(0.6f, 1e-5f)));
}

TEST_P(StartOn, RobotsThatComeLaterAndTheSecondSideBeginThereToo) {
  LiveScene scene(options(around(0.6)));
  test::make_robots(scene, 1);
  const std::vector<Vec3> start = positions_of(scene);
  scene.comparison().set_second(SideDifference("damping=1"));
  scene.wait_until_done();
  ASSERT_TRUE(scene.snapshot().second);
  EXPECT_TRUE(same_bits(scene.snapshot().second->positions.host(), start));
  test::step_and_wait(scene, 100);
  scene.robots().add({*scene.document().robots.front().body.robot});
  scene.wait_until_done();
  EXPECT_TRUE(same_bits(std::span<const Vec3>(positions_of(scene)).subspan(start.size()), start));
  test::reset_and_wait(scene);
  EXPECT_TRUE(same_bits(scene.snapshot().second->positions.host().first(start.size()), start));
}

class Start : public test::FolderTest {
 protected:
  static LiveSceneOptions options(const TrialStart& start, Environment environment = Ocean{}) {
    LiveSceneOptions options = test::on_cpu(environment);
    options.configuration.environment.target = target;
    options.start = start;
    return options;
  }
  // The first frame of a recording by the program.
  std::vector<Vec3> recorded(const test::Arguments& words) {
    const std::vector<std::string> record{"--record", path("first.h5"), "--seconds", "0.01", "--device=cpu", "--force"};
    test::succeeded(test::mercury(test::joined(words, record)));
    TrajectoryReader reader(path("first.h5"));
    const std::span<const Vec3> positions = reader.positions(0);
    return {positions.begin(), positions.end()};
  }
};

TEST_F(Start, AScenesRobotsBeginWhereTheWindowsDidInEveryCommand) {
  for (const Environment& environment : {Environment(Ocean{}), Environment(Land{})}) {
    LiveScene scene(options(around(0.6), environment));
    test::make_robots(scene, 2, 3);
    const std::vector<Vec3> start = positions_of(scene);
    ASSERT_TRUE(scene.files().save_scene(path("around.toml"), true).ok());
    LiveScene again(test::on_cpu());
    test::open_and_wait(again, {path("around.toml")});
    EXPECT_EQ(again.document().start, scene.document().start);
    EXPECT_TRUE(same_bits(positions_of(again), start));
    EXPECT_TRUE(same_bits(recorded({"run", path("around.toml")}), start));
    // As videos and exports, and `mercury run` with the options.
    std::vector<LiveRobot> robots;
    for (const DocumentRobot& robot : scene.document().robots) robots.push_back(robot.body);
    std::vector<Vec3> in_videos(start.size());
    simulation_of(robots, scene.document().configuration, scene.document().start).read_positions(in_videos);
    EXPECT_TRUE(same_bits(in_videos, start));
    EXPECT_TRUE(same_bits(
        recorded({"run", "--random", "voxel:2", "--seed", "3", "--environment", std::string(name_of(environment)),
                  "--target", "0.3,0.2,0", "--target-radius", "0.6", "--turned"}),
        start));
  }
}

TEST_F(Start, TheCommandBeginsThere) {
  LiveScene scene(options(around(0.6)));
  test::make_robots(scene, 1);
  EXPECT_THAT(scene.files().command("view").text, HasSubstr(" --target-radius=0.6 --turned --seed=3 "));
  EXPECT_THAT(scene.files().command("render").text, HasSubstr(" --target-radius=0.6 --turned --seed=3 "));
  scene.parameters().set_start({});
  EXPECT_THAT(scene.files().command("view").text, testing::Not(HasSubstr("--seed")));
}

TEST_F(Start, BadValuesInASceneAreRefusedWithTheirLine) {
  const auto refusal = [&](const std::string& line) -> std::string {
    write("bad.toml", "format = \"mercury-scene\"\nversion = 1\n" + line + "\n");
    return mercury::refusal([&] { const SceneFile scene(path("bad.toml")); });
  };
  EXPECT_EQ(refusal("target-radius = -1.0"),
            path("bad.toml") + ":3: --target-radius: -1 is not accepted; give a finite number >= 0 m");
  EXPECT_EQ(refusal("target-spread = 1.5"), path("bad.toml") + ":3: --target-spread: 1.5 is not accepted; give 0 to 1");
  EXPECT_THAT(refusal("turned = 3"), testing::StartsWith(path("bad.toml") + ":3: "));
  EXPECT_EQ(refusal("target-radius = 2\nturned = true"), "");
}

// A pin of a scene holds its mass where it begins.
TEST_F(Start, PinsHoldMassesWhereTheyBegin) {
  LiveScene scene(options(around(0.6)));
  scene.files().hold_opened({.attached = {{.robot = 0, .mass = 2, .spring = {}}}});
  test::make_robots(scene, 1);
  const Vec3 start = positions_of(scene)[2];
  test::step_and_wait(scene, 500);
  EXPECT_LT(length(positions_of(scene)[2] - start), 0.02f);
}

TEST_F(Start, TheWindowRefusesToBeginARecordingElsewhere) {
  test::succeeded(test::mercury({"run", "--random", "voxel:1", "--seconds", "0.01", "--record", path("a.h5")}));
  for (const test::Arguments& option :
       {std::vector<std::string>{"--target-radius", "1"}, std::vector<std::string>{"--turned"}}) {
    const test::Outcome outcome = test::mercury(test::joined({"view", path("a.h5")}, option));
    EXPECT_EQ(outcome.status, 2);
    EXPECT_EQ(outcome.messages, "mercury: " + option[0] + ": a recording has its own start; give robots to simulate\n");
  }
}

}  // namespace
}  // namespace mercury
