// SPDX-License-Identifier: Apache-2.0
// The timeline: every earlier moment is shown again bit for bit, and can be gone on from.
#include <gmock/gmock.h>

#include <algorithm>
#include <cstring>
#include <functional>
#include <map>

#include "app/live/scene_mouse.h"
#include "app/live/scene_parameters.h"
#include "app/live/scene_robots.h"
#include "app/live/scene_time.h"
#include "app/live/timeline.h"
#include "mercury/random_voxel.h"
#include "tests/app/live/live_scene_setup.h"
#include "tests/app/program.h"
#include "tests/app/recording/recording_bodies.h"
#include "tests/nap.h"
#include "tests/same_bits.h"
#include "tests/sim/backend.h"

namespace mercury {
namespace {

// What a picture shows of the robots.
struct Moment {
  double time = 0;
  std::int64_t steps = 0;
  Configuration configuration;
  std::vector<RobotId> robots;
  std::vector<Vec3> positions, velocities;
  std::vector<LivePerturbation> perturbations;
};

Moment moment_of(const LiveScene& scene) {
  const Snapshot& snapshot = scene.snapshot();
  Moment moment{.time = snapshot.time,
                .steps = snapshot.steps,
                .configuration = snapshot.configuration,
                .robots = {},
                .positions = {snapshot.positions.host().begin(), snapshot.positions.host().end()},
                .velocities = snapshot.velocities,
                .perturbations = snapshot.perturbations};
  for (const LiveRobot& robot : snapshot.robots->robots) moment.robots.push_back(robot.id);
  return moment;
}

// Expects the scene to show that moment, apart from changes that take effect with the next step.
void expect_shown(const LiveScene& scene, const Moment& moment) {
  EXPECT_EQ(scene.snapshot().steps, moment.steps);
  EXPECT_EQ(scene.snapshot().time, moment.time);
  EXPECT_TRUE(same_bits(scene.snapshot().positions.host(), moment.positions)) << "positions at " << moment.time << " s";
  EXPECT_TRUE(same_bits(scene.snapshot().velocities, moment.velocities)) << "velocities at " << moment.time << " s";
}

class TimelineOn : public BackendTest {
 protected:
  LiveSceneOptions options(Environment environment = Ocean{}) const {
    return {.configuration = {.environment = environment, .device = device()}};
  }
  // A run with all kinds of changes on its way, and moments of it.
  void make_history(LiveScene& scene) {
    const auto keep = [&] { moments_.push_back(moment_of(scene)); };
    test::make_robots(scene, 3);
    const std::vector<RobotId> robots = test::ids_of(scene);
    test::step_and_wait(scene, 40);
    keep();
    scene.mouse().begin_perturbation({.robot = robots[0], .index = 0, .mass = 2}, 30);
    scene.mouse().move_perturbation(scene.mouse().perturbation()->at + render::Vector3(0.3f, 0, 0));
    test::step_and_wait(scene, 25);
    keep();
    scene.mouse().move_perturbation(scene.mouse().perturbation()->at + render::Vector3(0, 0.4f, 0));
    test::step_and_wait(scene, 10);
    scene.mouse().end_perturbation();
    Configuration configuration = scene.document().configuration;
    configuration.dt = 7e-4;
    configuration.damping = 0.4;
    scene.parameters().set_configuration(configuration);
    test::step_and_wait(scene, 30);
    keep();
    Material stiff = scene.parameters().materials(robots[1])[3];
    stiff.stiffness *= 2;
    scene.parameters().set_material({robots[1]}, 3, stiff);
    test::step_and_wait(scene, 20);
    keep();
    test::step_and_wait(scene, 5);
    scene.robots().remove({robots[2]});
    test::step_and_wait(scene, 20);
    keep();
    test::step_and_wait(scene, 5);
    scene.undo();
    scene.robots().duplicate({robots[0]});
    test::step_and_wait(scene, 35);
    keep();
  }
  std::vector<Moment> moments_;
};
INSTANTIATE_TEST_SUITE_P(All, TimelineOn, every_device, BackendTest::name);

TEST_P(TimelineOn, EveryMomentIsShownAgainBitForBit) {
  LiveScene scene(options());
  make_history(scene);
  EXPECT_FALSE(scene.snapshot().timeline.viewing);
  EXPECT_EQ(scene.snapshot().timeline.begin, 0);
  for (const std::size_t i : {4u, 0u, 2u, 5u, 1u, 3u, 3u, 0u, 4u}) {
    test::seek_and_wait(scene, moments_[i].time);
    EXPECT_EQ(scene.snapshot().timeline.viewing, i != 5);
    EXPECT_EQ(scene.snapshot().timeline.head, moments_[5].time);
    expect_shown(scene, moments_[i]);
    EXPECT_EQ(moment_of(scene).robots, moments_[i].robots);
    EXPECT_EQ(scene.snapshot().configuration, moments_[i].configuration);
  }
}

TEST_P(TimelineOn, PlayingFromThePastRepeatsTheChangesAndReturnsToThePresent) {
  LiveScene scene(options()), uninterrupted(options());
  make_history(scene);
  test::seek_and_wait(scene, moments_[0].time);
  for (std::size_t i = 1; i < moments_.size(); ++i) {
    test::step_and_wait(scene, moments_[i].steps - moments_[i - 1].steps);
    expect_shown(scene, moments_[i]);
  }
  EXPECT_FALSE(scene.snapshot().timeline.viewing);
  test::step_and_wait(scene, 50);
  moments_.clear();
  make_history(uninterrupted);
  test::step_and_wait(uninterrupted, 50);
  expect_shown(scene, moment_of(uninterrupted));
}

TEST_P(TimelineOn, RobotsThatWereAllRemovedDoNotComeBackToThePresent) {
  test::RobotScene scene(2, options());
  test::step_and_wait(scene, 20);
  const Moment earlier = moment_of(scene);
  test::step_and_wait(scene, 20);
  const std::vector<RobotId> robots = test::ids_of(scene);
  scene.robots().remove(robots);
  scene.wait_until_done();
  const Moment present = moment_of(scene);
  ASSERT_TRUE(present.robots.empty());
  const std::vector<std::function<void()>> ways{[&] { scene.time().seek(present.time); },
                                                [&] { scene.time().step(20); }, [&] { scene.time().step(100); }};
  for (std::size_t i = 0; i < ways.size(); ++i) {
    SCOPED_TRACE(i);
    test::seek_and_wait(scene, earlier.time);
    expect_shown(scene, earlier);
    EXPECT_EQ(moment_of(scene).robots, robots);
    ways[i]();
    scene.wait_until_done();
    EXPECT_FALSE(scene.snapshot().timeline.viewing);
    expect_shown(scene, present);
    EXPECT_EQ(moment_of(scene).robots, present.robots);
  }
  test::undo_and_wait(scene);
  EXPECT_EQ(moment_of(scene).robots, robots);
  EXPECT_EQ(scene.snapshot().steps, 40);
  scene.time().seek(earlier.time);
  test::seek_and_wait(scene, present.time);
  EXPECT_EQ(moment_of(scene).robots, robots);
}

TEST_P(TimelineOn, StepsBackAreThoseForward) {
  test::RobotScene scene(2, options(Land{}));
  std::map<std::int64_t, Moment> moments;
  for (int i = 0; i < 20; ++i) {
    test::step_and_wait(scene, 1);
    moments[scene.snapshot().steps] = moment_of(scene);
  }
  for (std::int64_t step = 19; step > 10; --step) {
    scene.time().step_back();
    scene.wait_until_done();
    expect_shown(scene, moments.at(step));
  }
  scene.time().step_back(5);
  scene.time().step_back(2);
  scene.wait_until_done();
  expect_shown(scene, moments.at(4));
  scene.time().step_back(100);
  scene.wait_until_done();
  EXPECT_EQ(scene.snapshot().steps, 0);
}

TEST_P(TimelineOn, GoingOnForgetsWhatCameLater) {
  LiveScene scene(options());
  make_history(scene);
  test::seek_and_wait(scene, moments_[1].time);
  scene.time().go_on();
  scene.wait_until_done();
  EXPECT_FALSE(scene.snapshot().timeline.viewing);
  EXPECT_EQ(scene.snapshot().timeline.head, moments_[1].time);
  expect_shown(scene, moments_[1]);
  EXPECT_EQ(scene.document().configuration, moments_[1].configuration)
      << "the document has the parameters of that moment";
  EXPECT_EQ(test::ids_of(scene), moments_[1].robots);
  test::seek_and_wait(scene, moments_[5].time);
  expect_shown(scene, moments_[1]);
  EXPECT_EQ(scene.history().undo_name(), "go back to 0.065 s");
  test::undo_and_wait(scene);
  EXPECT_EQ(scene.document().configuration, moments_[5].configuration);
  EXPECT_EQ(test::ids_of(scene), moments_[5].robots);
}

TEST_P(TimelineOn, AnEditInThePastGoesOnFromThere) {
  LiveScene scene(options());
  make_history(scene);
  test::seek_and_wait(scene, moments_[2].time);
  Configuration configuration = scene.document().configuration;
  configuration.damping = 2;
  scene.parameters().set_configuration(configuration);
  scene.wait_until_done();
  EXPECT_FALSE(scene.snapshot().timeline.viewing);
  expect_shown(scene, moments_[2]);
  EXPECT_EQ(scene.document().configuration.damping, 2);
  EXPECT_EQ(test::ids_of(scene), moments_[2].robots);
  test::undo_and_wait(scene);
  EXPECT_EQ(scene.document().configuration, moments_[2].configuration);
}

TEST_P(TimelineOn, DrivesByHandBelongToTheTimelineAndToUndo) {
  LiveScene scene(options()), free(options());
  std::vector<Moment> moments;
  for (LiveScene* one : {&scene, &free}) {
    test::make_robots(*one, 2);
    test::step_and_wait(*one, 30);
  }
  const std::vector<RobotId> robots = test::ids_of(scene);
  const auto drives = [&] {
    const auto& held = scene.document().robots[0].body.by_hand;
    return held ? &held->drives : nullptr;
  };
  const std::string name = actuators_of(*scene.document().robots[0].body.robot).front().name;
  moments.push_back(moment_of(scene));
  scene.parameters().drive_actuator(robots, name, 0.8f);
  scene.end_edit();
  test::step_and_wait(scene, 30);
  test::step_and_wait(free, 30);
  moments.push_back(moment_of(scene));
  EXPECT_FALSE(same_bits(scene.snapshot().positions.host(), free.snapshot().positions.host()));
  scene.parameters().drive_actuator(robots, name, {});
  scene.end_edit();
  EXPECT_FALSE(drives()) << "released";
  test::step_and_wait(scene, 30);
  moments.push_back(moment_of(scene));
  for (const std::size_t i : {0, 2, 1}) {
    test::seek_and_wait(scene, moments[i].time);
    expect_shown(scene, moments[i]);
  }
  test::seek_and_wait(scene, moments[2].time);
  scene.undo();
  ASSERT_TRUE(drives());
  EXPECT_EQ(drives()->front(), 0.8f);
  scene.undo();
  EXPECT_FALSE(drives());
  scene.redo();
  ASSERT_TRUE(drives());
  // At an earlier moment, the document takes the drives of that moment before the next edit.
  test::seek_and_wait(scene, moments[0].time);
  scene.time().go_on();
  EXPECT_FALSE(drives());
}

TEST_P(TimelineOn, AForkMovesAsItsOriginalUntilItIsChanged) {
  LiveScene scene(options());
  make_history(scene);
  test::seek_and_wait(scene, moments_[1].time);
  const RobotId original = test::ids_of(scene)[1];
  const std::vector<RobotId> copies = scene.robots().fork({original});
  ASSERT_EQ(copies.size(), 1u);
  test::step_and_wait(scene, 60);
  const Snapshot& snapshot = scene.snapshot();
  const auto a = snapshot.robots->index_of(original), b = snapshot.robots->index_of(copies[0]);
  ASSERT_TRUE(a && b);
  EXPECT_TRUE(std::ranges::equal(snapshot.positions_of(*a), snapshot.positions_of(*b)));
  EXPECT_EQ(snapshot.steps, moments_[1].steps + 60);
  scene.parameters().scale_materials(copies, {.stiffness = 0.5f});
  test::step_and_wait(scene, 60);
  EXPECT_FALSE(std::ranges::equal(scene.snapshot().positions_of(*a), scene.snapshot().positions_of(*b)));
}

TEST_P(TimelineOn, ALoopPlaysBetweenItsEnds) {
  LiveScene scene(options());
  make_history(scene);
  scene.time().set_loop(std::pair{moments_[0].time, moments_[1].time});
  scene.time().set_speed(unlimited_speed);
  scene.time().play();
  const std::uint64_t before = scene.snapshot().resets;
  while (scene.snapshot().resets < before + 3) {
    scene.frame();
    if (scene.snapshot().resets > before) {
      EXPECT_LE(scene.snapshot().steps, moments_[1].steps);
    }
    test::nap();
  }
  scene.time().pause();
  scene.time().set_loop({});
  test::seek_and_wait(scene, moments_[5].time);
  expect_shown(scene, moments_[5]);
}

TEST_P(TimelineOn, WithoutMemoryThereIsOnlyThePresent) {
  LiveScene scene(options());
  scene.time().set_timeline_budget(1);
  make_history(scene);
  EXPECT_EQ(scene.snapshot().timeline.bytes, 0u);
  scene.time().seek(0);
  scene.time().step_back();
  scene.wait_until_done();
  expect_shown(scene, moments_[5]);
  EXPECT_FALSE(scene.snapshot().timeline.viewing);
}

TEST_P(TimelineOn, ResetBeginsTheTimelineAgain) {
  LiveScene scene(options());
  make_history(scene);
  scene.time().seek(moments_[2].time);
  test::reset_and_wait(scene);
  EXPECT_EQ(scene.snapshot().steps, 0);
  EXPECT_FALSE(scene.snapshot().timeline.viewing);
  EXPECT_EQ(scene.snapshot().timeline.head, 0);
}

TEST_P(TimelineOn, PathsEndWhereTheRobotsWereAtTheMomentShown) {
  Ocean current;
  current.flow = {0.5f, 0, 0};
  LiveSceneOptions wanted = options(current);
  wanted.view.shown.path = true;
  test::RobotScene scene(1, wanted);
  const auto points = [&] { return scene.drawn().scene().paths[0].points; };
  std::vector<float> earlier;
  double moment = 0;
  for (int i = 0; i < 40; ++i) {
    test::step_and_wait(scene, 100);
    if (i != 19) continue;
    earlier.assign(points().begin(), points().end());
    moment = scene.snapshot().time;
  }
  const std::vector<float> whole(points().begin(), points().end());
  ASSERT_GT(whole.size(), earlier.size()) << "the robot has moved";
  test::seek_and_wait(scene, moment);
  scene.frame();
  EXPECT_TRUE(std::ranges::equal(points(), earlier));
  test::seek_and_wait(scene, scene.snapshot().timeline.head);
  scene.frame();
  EXPECT_TRUE(std::ranges::equal(points(), whole));
  // What came later is forgotten when the robot goes on from an earlier moment.
  test::seek_and_wait(scene, moment);
  scene.time().go_on();
  test::step_and_wait(scene, 1);
  EXPECT_TRUE(std::ranges::equal(points().first(earlier.size()), earlier));
  EXPECT_LE(points().size(), earlier.size() + 3);
}

// Recordings.

class PlayedRecording : public test::FolderTest, public testing::WithParamInterface<DeviceKind> {
 protected:
  void SetUp() override {
    BackendTest::skip_without(GetParam());
    if (IsSkipped()) return;
    for (std::uint64_t i = 0; i < 2; ++i) robots_.push_back(test::small_voxel_robot(i));
    Simulation simulation({.environment = Land{}, .device = {.kind = GetParam()}}, robots_);
    test::record(simulation, path("walk.h5"), 100, 10);
  }
  void open(LiveScene& scene) { test::open_and_wait(scene, {path("walk.h5")}); }
  std::vector<Robot> robots_;
};
INSTANTIATE_TEST_SUITE_P(All, PlayedRecording, every_device, BackendTest::name);

TEST_P(PlayedRecording, ShowsItsFramesAndStraightLinesBetween) {
  LiveScene scene({.configuration = {.device = {.kind = GetParam()}}});
  open(scene);
  EXPECT_TRUE(scene.snapshot().timeline.recording);
  EXPECT_NEAR(scene.snapshot().timeline.head, 0.1, 1e-12);
  EXPECT_TRUE(has_ground(scene.document().configuration.environment));
  TrajectoryReader reader(path("walk.h5"));
  for (const std::size_t frame : {3u, 10u, 0u, 7u}) {
    test::seek_and_wait(scene, reader.time(frame));
    EXPECT_TRUE(std::ranges::equal(scene.snapshot().positions.host(), reader.positions(frame)));
    EXPECT_EQ(scene.snapshot().steps, reader.step(frame));
  }
  test::seek_and_wait(scene, (reader.time(3) + reader.time(4)) / 2);
  const std::vector<Vec3> before(reader.positions(3).begin(), reader.positions(3).end());
  const auto after = reader.positions(4);
  for (std::size_t i = 0; i < before.size(); ++i)
    EXPECT_NEAR(scene.snapshot().positions.host()[i].x, 0.5f * (before[i].x + after[i].x), 1e-6);
}

TEST_P(PlayedRecording, GoesOnFromAFrameAsTheRobotsDid) {
  LiveScene scene({.configuration = {.device = {.kind = GetParam()}}});
  open(scene);
  scene.time().seek(0.045);  // between frames 4 and 5
  scene.time().go_on();
  scene.wait_until_done();
  EXPECT_FALSE(scene.snapshot().timeline.recording);
  EXPECT_EQ(scene.snapshot().steps, 40);
  test::step_and_wait(scene, 210);
  Simulation simulation({.environment = Land{}, .device = {.kind = GetParam()}}, robots_);
  simulation.step(250);
  std::vector<Vec3> positions(simulation.mass_count());
  simulation.read_positions(positions);
  EXPECT_TRUE(same_bits(scene.snapshot().positions.host(), positions));
  test::seek_and_wait(scene, 0.04);
  EXPECT_EQ(scene.snapshot().steps, 40) << "the live run has a timeline of its own";
}

TEST_P(PlayedRecording, ShowsTheSensesAndNeuronsOfTheWatchedRobotAndGoesOnWithThem) {
  const std::vector robots{robots_[0], test::thinking_pair("thinker")};
  const Configuration configuration{.environment = OceanSimple{.flow = {0, 0, -1}}, .device = {.kind = GetParam()}};
  Simulation simulation(configuration, robots);
  test::record(simulation, path("think.h5"), 100, 10, {.brains = true});
  LiveScene scene({.configuration = {.device = {.kind = GetParam()}}});
  test::open_and_wait(scene, {path("think.h5")});
  const std::vector<RobotId> ids = test::ids_of(scene);
  scene.watch_brain(ids[0]);  // it has none
  scene.wait_until_done();
  EXPECT_FALSE(scene.snapshot().brain || scene.snapshot().brain_history);
  scene.watch_brain(ids[1]);

  TrajectoryReader reader(path("think.h5"));
  for (const std::size_t frame : {3u, 10u, 0u, 7u}) {
    scene.time().seek(reader.time(frame) + (frame == 3 ? 0.004 : 0));  // until the next frame
    scene.wait_until_done();
    ASSERT_TRUE(scene.snapshot().brain);
    EXPECT_EQ(scene.snapshot().brain->robot, ids[1]);
    EXPECT_TRUE(std::ranges::equal(scene.snapshot().brain->senses, reader.senses_of(1, frame))) << frame;
    EXPECT_TRUE(std::ranges::equal(scene.snapshot().brain->neurons, reader.neurons_of(1, frame))) << frame;
  }
  const std::shared_ptr<const BrainHistory> history = scene.snapshot().brain_history;
  ASSERT_TRUE(history);
  ASSERT_EQ(history->times.size(), 11u);
  for (std::size_t frame = 0; frame < 11; ++frame) {
    EXPECT_EQ(history->times[frame], reader.time(frame));
    EXPECT_TRUE(std::ranges::equal(history->activity[frame].senses, reader.senses_of(1, frame)));
    EXPECT_TRUE(std::ranges::equal(history->activity[frame].neurons, reader.neurons_of(1, frame)));
  }

  scene.time().seek(0.05);
  scene.time().go_on();
  test::step_and_wait(scene, 100);
  EXPECT_FALSE(scene.snapshot().brain_history);
  simulation.step(50);
  EXPECT_EQ(scene.snapshot().brain->neurons, simulation.brain_state(1).neurons) << "as if it had not been recorded";
  std::vector<Vec3> positions(simulation.mass_count());
  simulation.read_positions(positions);
  EXPECT_TRUE(same_bits(scene.snapshot().positions.host(), positions));
}

TEST_P(PlayedRecording, UndoBringsBackTheSceneAndItsClock) {
  const LiveSceneOptions options{.configuration = {.device = {.kind = GetParam()}}};
  LiveScene scene(options), uninterrupted(options);
  for (LiveScene* one : {&scene, &uninterrupted}) {
    test::make_robots(*one, 2);
    test::step_and_wait(*one, 70);
  }
  open(scene);
  test::seek_and_wait(scene, 0.045);
  test::undo_and_wait(scene);
  EXPECT_FALSE(scene.snapshot().timeline.recording);
  EXPECT_EQ(scene.snapshot().steps, 70);
  EXPECT_TRUE(same_bits(scene.snapshot().positions.host(), uninterrupted.snapshot().positions.host()));
  for (LiveScene* one : {&scene, &uninterrupted}) test::step_and_wait(*one, 30);
  EXPECT_TRUE(same_bits(scene.snapshot().positions.host(), uninterrupted.snapshot().positions.host()));
}

TEST_P(PlayedRecording, PlaysToItsEndAndPausesThere) {
  LiveScene scene({.configuration = {.device = {.kind = GetParam()}}});
  open(scene);
  scene.time().set_speed(100);
  scene.time().play();
  while (scene.time().playing()) {
    scene.frame();
    test::nap();
  }
  scene.wait_until_done();
  EXPECT_EQ(scene.snapshot().steps, 100);
  EXPECT_TRUE(scene.snapshot().timeline.recording);
  test::reset_and_wait(scene);
  EXPECT_EQ(scene.snapshot().steps, 0);
  test::step_and_wait(scene);
  EXPECT_EQ(scene.snapshot().steps, 10) << "a step is a frame";
  scene.time().step_back();
  scene.wait_until_done();
  EXPECT_EQ(scene.snapshot().steps, 0);
}

// The store.

Keyframe keyframe_at(std::int64_t step, double work, std::uint64_t era = 0, std::size_t masses = 100) {
  return {.state = {.clock = {.step = step},
                    .positions = std::vector<Vec3>(masses),
                    .velocities = std::vector<Vec3>(masses),
                    .explosions = {},
                    .brains = {}},
          .configuration = {},
          .robots = {},
          .perturbations = {},
          .next_event = 0,
          .era = era,
          .work = work};
}

TEST(Timeline, StaysInItsBudgetAndThinsOutWhatIsOld) {
  Timeline timeline;
  timeline.set_budget(12 * keyframe_at(0, 0).bytes());
  for (std::int64_t i = 0; i < 60; ++i) {
    timeline.add(keyframe_at(i * 100, 0.25 * static_cast<double>(i)));
    ASSERT_LE(timeline.bytes(), timeline.budget());
  }
  EXPECT_EQ(timeline.size(), 12u);
  // 15 s of work fit into 12 keyframes with no gap above 8 s.
  EXPECT_EQ(timeline.front().step(), 0);
  std::int64_t newer = 0, older = 0;  // keyframes in either half
  for (std::int64_t step = 0; step < 6000; step += 100)
    if (timeline.before(step)->step() == step) ++(step < 3000 ? older : newer);
  EXPECT_GT(newer, older);
  EXPECT_EQ(timeline.before(5900)->step(), 5900);
}

TEST(Timeline, LosesTheOldestRatherThanLongGaps) {
  Timeline timeline;
  timeline.set_budget(4 * keyframe_at(0, 0).bytes());
  for (std::int64_t i = 0; i < 40; ++i) timeline.add(keyframe_at(i * 100, 5.0 * static_cast<double>(i)));
  EXPECT_EQ(timeline.size(), 4u);
  EXPECT_EQ(timeline.front().step(), 3600);
  EXPECT_EQ(timeline.before(3500), nullptr);
}

TEST(Timeline, KnowsTimesAcrossChangesOfTheTimeStep) {
  Timeline timeline;
  timeline.note({.dt = 0.01});
  timeline.note({.dt = 0.02, .base_time = 1, .base_step = 100});
  EXPECT_EQ(timeline.step_at(0.5), 50);
  EXPECT_EQ(timeline.step_at(1.5), 125);
  EXPECT_EQ(timeline.step_at(-3), 0);
  EXPECT_DOUBLE_EQ(timeline.time_at(50), 0.5);
  EXPECT_DOUBLE_EQ(timeline.time_at(125), 1.5);
  timeline.cut(60, 0);
  timeline.note({.dt = 0.01});
  EXPECT_EQ(timeline.step_at(1.5), 150);
}

TEST(Timeline, ACutForgetsLaterKeyframesAndEras) {
  Timeline timeline;
  for (std::int64_t i = 0; i < 5; ++i) timeline.add(keyframe_at(i * 10, 0.1 * static_cast<double>(i), i < 3 ? 0 : 1));
  EXPECT_EQ(timeline.next_era(0)->step(), 30);
  timeline.cut(25, 0);
  EXPECT_EQ(timeline.size(), 3u);
  EXPECT_EQ(timeline.next_era(0), nullptr);
}

}  // namespace
}  // namespace mercury
