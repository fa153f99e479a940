// SPDX-License-Identifier: Apache-2.0
// A repro repeats an explosion of the window, in `mercury run` and in the window.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <iomanip>
#include <sstream>

#include "app/live/picking.h"
#include "app/live/replay_log.h"
#include "app/live/robot_saving.h"
#include "app/live/scene_files.h"
#include "app/live/scene_mouse.h"
#include "app/live/scene_parameters.h"
#include "app/live/scene_robots.h"
#include "app/live/scene_time.h"
#include "app/recording/repro.h"
#include "mercury/random_voxel.h"
#include "tests/app/live/live_scene_setup.h"
#include "tests/app/program.h"
#include "tests/refusal.h"

namespace mercury {
namespace {

using test::ids_of;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::SizeIs;

class LiveRepro : public test::FolderTest {
 protected:
  // All kinds of changes that a user can make, then a time step that lets the robot explode.
  static void torment(LiveScene& scene, RobotId robot) {
    const auto step = [&](std::int64_t count) { test::step_and_wait(scene, count); };
    step(40);
    const std::size_t index = *scene.snapshot().robots->index_of(robot);
    scene.mouse().begin_perturbation({.robot = robot, .index = index, .mass = 3}, 40);
    for (int i = 0; i < 5; ++i) {
      scene.mouse().move_perturbation(scene.mouse().perturbation()->at +
                                      render::Vector3(0.1f * static_cast<float>(i), 0.2f, 0));
      step(7);
    }
    Material muscle = scene.parameters().materials(robot)[2];
    muscle.frequency *= 3;
    muscle.phase = 0.7f;
    muscle.half_wave = true;
    muscle.relaxation_time = 0.001f;
    scene.parameters().set_material({robot}, 2, muscle);
    step(33);
    scene.parameters().scale_materials({robot}, {.stiffness = 1.5f});
    Configuration configuration = scene.document().configuration;
    configuration.damping = 0.4;
    configuration.dt = 7e-4;
    scene.parameters().set_configuration(configuration);
    step(50);
    scene.mouse().set_perturbation_stiffness(90);
    configuration.dt = 0.3;
    scene.parameters().set_configuration(configuration);
    step(300);
  }
  // Without the step at which the explosion was noticed: it depends on how the steps fall into slices.
  nlohmann::json content(const std::string& file) {
    auto document = nlohmann::json::parse(read(file));
    document["exploded"].erase("last_step");
    return document;
  }
  static std::string hash_of(const LiveScene& scene, RobotId robot) {
    const std::size_t index = *scene.snapshot().robots->index_of(robot);
    Simulation same({.device = {.kind = DeviceKind::cpu}},
                    std::span(scene.snapshot().robots->robots[index].robot.get(), 1));
    same.set_state(0, scene.snapshot().positions_of(index), scene.snapshot().velocities_of(index));
    std::ostringstream text;
    text << std::hex << std::setw(16) << std::setfill('0') << same.hash(0);
    return text.str();
  }
};

TEST_F(LiveRepro, RepeatsTheExplosionBitForBitWithAllChanges) {
  for (const Environment& environment : {Environment(Ocean{}), Environment(Land{})}) {
    test::RobotScene scene(1, test::on_cpu(environment));
    test::step_and_wait(scene, 25);
    test::make_robots(scene, 2, 9);  // added while the scene is running
    const RobotId robot = ids_of(scene)[1];
    torment(scene, robot);
    const auto exploded = scene.exploded();
    const auto it = std::ranges::find(exploded, robot, &ExplodedRobot::robot);
    ASSERT_NE(it, exploded.end());
    const std::string folder = std::string("repro-") + std::string(name_of(environment));
    const SaveResult saved = scene.files().save_repro(robot, folder_ / folder);
    ASSERT_TRUE(saved.ok()) << saved.message;
    EXPECT_EQ(scene.files().save_repro(robot, folder_ / folder).outcome, SaveResult::Outcome::exists);

    const std::string file = path(folder + "/voxel-9-0.repro");
    const test::Outcome run =
        test::succeeded(test::mercury({"run", file, "--device", "cpu", "--threads", "1", "--json", "--quiet"}));
    const auto reported = nlohmann::json::parse(run.output)["robots"][0];
    EXPECT_TRUE(reported["exploded"]);
    EXPECT_EQ(reported["exploded_at"].get<double>(), it->time);
    EXPECT_EQ(reported["first_bad_spring"], it->spring->index);
    EXPECT_EQ(reported["hash"], hash_of(scene, robot)) << "frozen in the same state";

    // In the window, twice: a reset returns to the start of the repro.
    test::RobotScene again(1);
    again.time().step(10);
    again.time().play();
    test::open_and_wait(again, {file});
    EXPECT_FALSE(again.time().playing()) << "it waits before the explosion";
    EXPECT_EQ(test::names_of(again), std::vector<std::string>{"voxel-9-0"});
    EXPECT_NEAR(again.snapshot().time, 0.025, 1e-12);
    for (int round = 0; round < 2; ++round) {
      test::step_and_wait(again, scene.snapshot().steps - again.snapshot().steps);
      ASSERT_THAT(again.exploded(), SizeIs(1));
      EXPECT_EQ(again.exploded()[0].time, it->time);
      EXPECT_EQ(again.exploded()[0].spring->index, it->spring->index);
      EXPECT_EQ(hash_of(again, again.exploded()[0].robot), hash_of(scene, robot));
      // Saving it again gives the same file.
      ASSERT_TRUE(again.files().save_repro(ids_of(again)[0], folder_ / "again", true).ok());
      EXPECT_TRUE(content("again/voxel-9-0.repro") == content(folder + "/voxel-9-0.repro"));
      test::reset_and_wait(again);
      EXPECT_NEAR(again.snapshot().time, 0.025, 1e-12);
      EXPECT_THAT(again.exploded(), IsEmpty());
    }
  }
}

TEST_F(LiveRepro, ChangeInTheWindowEndsTheReplay) {
  test::RobotScene scene(1);
  torment(scene, ids_of(scene)[0]);
  ASSERT_TRUE(scene.files().save_repro(ids_of(scene)[0], folder_).ok());
  LiveScene again(test::on_cpu());
  test::open_and_wait(again, {path("voxel-5-0.repro")});
  EXPECT_FALSE(again.robots().entries()[0].unsaved);
  again.parameters().scale_materials(ids_of(again), {.stiffness = 0.5f});
  test::step_and_wait(again, 400);
  EXPECT_THAT(again.exploded(), IsEmpty()) << "the recorded change of the time step is not applied";
  EXPECT_EQ(again.snapshot().configuration.dt, 1e-3);
  EXPECT_EQ(again.files().save_repro(ids_of(again)[0], folder_, true).outcome, SaveResult::Outcome::failed);
  // A repro cannot be opened together with other files; they are opened without it.
  save_robot(path("one.json"), random_voxel_robot({}, 1, 0));
  again.take_messages();
  test::open_and_wait(again, {path("voxel-5-0.repro"), path("one.json")});
  EXPECT_THAT(again.robots().entries(), SizeIs(2));
  const auto messages = again.take_messages();
  ASSERT_THAT(messages, SizeIs(1));
  EXPECT_THAT(messages[0].text, HasSubstr("open it alone"));
}

TEST_F(LiveRepro, StartsSomeSecondsBeforeTheExplosionAfterALongRun) {
  Robot with_actuators = random_voxel_robot({}, 5, 0);
  with_actuators.actuators = actuators_of(with_actuators);
  const auto robot = std::make_shared<const Robot>(with_actuators);
  const Configuration configuration = test::on_cpu().configuration;
  Simulation simulation(configuration, std::span(robot.get(), 1));
  LiveRobots robots{.robots = {{.id = 4, .name = "it", .robot = robot}}, .mass_offsets = {0, robot->masses.size()}};
  SceneEvents events;
  ReplayLog replay_log(events);
  replay_log.follow(simulation, robots, {});
  for (int i = 0; i < 5; ++i) {
    simulation.step(100);
    const std::vector<LivePerturbation> perturbations{
        {.robot = 4, .mass = 1, .target = {0.1f * static_cast<float>(i), 0, 1}, .stiffness = 20}};
    simulation.set_perturbations(
        std::vector<Perturbation>{{.mass = 1, .target = perturbations[0].target, .stiffness = 20}});
    replay_log.follow(simulation, robots, perturbations);
    simulation.step(100);
    replay_log.stepped(6, simulation, robots);
  }
  simulation.step(50);
  const Repro repro = replay_log.repro(simulation, robots, 0, simulation.telemetry(0))();
  EXPECT_EQ(repro.clock.step, 800);
  EXPECT_THAT(repro.changes, SizeIs(1));
  const Repro read = parse_repro(serialize_repro(repro));
  EXPECT_EQ(read.robot.actuators, with_actuators.actuators);
  Simulation same = start_of(read, configuration.device);
  ReproChanges changes(read);
  while (same.steps() < repro.last_step) {
    changes.apply(same);
    same.step(std::min(repro.last_step, changes.next_step()) - same.steps());
  }
  EXPECT_EQ(same.hash(0), simulation.hash(0));
}

TEST_F(LiveRepro, InvalidReproIsReportedInOneLine) {
  test::RobotScene scene(1);
  torment(scene, ids_of(scene)[0]);
  ASSERT_TRUE(scene.files().save_repro(ids_of(scene)[0], folder_).ok());
  const std::string whole = read("voxel-5-0.repro");
  const auto refused = [](const std::string& document) {
    const std::string message = refusal([&] { parse_repro(document); });
    return !message.empty() && message.find('\n') == std::string::npos;
  };
  for (std::size_t size = 0; size + 2 < whole.size(); size += whole.size() / 40)
    EXPECT_TRUE(refused(whole.substr(0, size))) << size;
  const auto document = nlohmann::json::parse(whole);
  for (const auto& [name, member] : document.items()) {
    if (name == "device_name") continue;
    auto changed = document;
    changed.erase(name);
    EXPECT_TRUE(refused(changed.dump())) << name;
    for (const auto& odd : {nlohmann::json(), nlohmann::json(-1), nlohmann::json("x"), nlohmann::json::array({1}),
                            nlohmann::json{{"step", -5}}}) {
      if (name == "changes" && odd.is_null()) continue;          // none
      if (name == "configuration" && odd.is_object()) continue;  // missing values have their defaults
      changed[name] = odd;
      EXPECT_TRUE(refused(changed.dump())) << name << " " << odd;
    }
  }
  for (const auto& [name, member] : document["start"].items()) {
    auto changed = document;
    changed["start"].erase(name);
    EXPECT_TRUE(refused(changed.dump())) << name;
    changed["start"][name] = "x";
    EXPECT_TRUE(refused(changed.dump())) << name;
  }
  auto changed = document;
  for (auto& change : changed["changes"])
    if (change.contains("materials")) {
      ASSERT_EQ(change["materials"][0].size(), 7u);
      EXPECT_EQ(change["materials"][0][6], 0.001);
      auto odd_time = changed;
      for (const auto& odd : {nlohmann::json(-1), nlohmann::json(), nlohmann::json("1")}) {
        for (auto& one : odd_time["changes"])
          if (one.contains("materials")) one["materials"][0][6] = odd;
        EXPECT_TRUE(refused(odd_time.dump())) << odd;
      }
      EXPECT_TRUE(change["materials"][0][5].get<bool>());
      for (const auto& odd : {nlohmann::json(1), nlohmann::json(), nlohmann::json("true")}) {
        change["materials"][0][5] = odd;
        EXPECT_TRUE(refused(changed.dump())) << odd;
      }
      break;
    }
  write("bad.repro", "{}");
  const test::Outcome run = test::mercury({"run", path("bad.repro")});
  EXPECT_EQ(run.status, 2);
  EXPECT_THAT(run.messages, HasSubstr("bad.repro: is not a repro"));
  EXPECT_EQ(test::mercury({"run", path("voxel-5-0.repro"), "--dt", "0.01"}).status, 2);
  EXPECT_EQ(test::mercury({"run", path("voxel-5-0.repro"), "--random", "voxel:2"}).status, 2);
  EXPECT_EQ(test::mercury({"render", path("voxel-5-0.repro"), "-o", path("x.mp4")}).status, 2);
}

}  // namespace
}  // namespace mercury
