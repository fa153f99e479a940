// SPDX-License-Identifier: Apache-2.0
// What the window exports for other programs: the pose that it shows, and motions from time 0.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cstring>

#include "app/live/background.h"
#include "app/live/robot_saving.h"
#include "app/live/scene_exports.h"
#include "app/live/scene_time.h"
#include "tests/app/live/live_scene_setup.h"
#include "tests/app/program.h"

namespace mercury {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

Vec3 vector_at(const std::string& content, std::size_t place) {
  Vec3 vector;
  std::memcpy(&vector, content.data() + place, sizeof vector);
  return vector;
}

class LiveExport : public test::FolderTest {
 protected:
  LiveExport() : scene_(test::on_cpu()) {
    test::make_robots(scene_, 2);
    robot_ = test::ids_of(scene_)[1];
  }
  const Robot& body() const { return *scene_.document().find(robot_)->body.robot; }
  // The message that a background task ends with.
  std::string last_message() {
    scene_.wait_until_done();
    const auto messages = scene_.take_messages();
    return messages.empty() ? "" : messages.back().text;
  }
  LiveScene scene_;
  RobotId robot_ = 0;
};

TEST_F(LiveExport, PoseIsThatOfTheSnapshot) {
  test::step_and_wait(scene_, 50);
  ASSERT_EQ(scene_.snapshot().steps, 50);
  ASSERT_TRUE(scene_.exports().pose(robot_, path("new/robot.stl")).ok());
  const std::string stl = read("new/robot.stl");
  ASSERT_EQ(stl.size(), 84 + 50 * body().faces.size());
  const auto positions = scene_.snapshot().positions_of(1);
  for (std::size_t i = 0; i < body().faces.size(); ++i) {
    EXPECT_EQ(vector_at(stl, 84 + 50 * i + 12), positions[body().faces[i].a]);
    EXPECT_EQ(vector_at(stl, 84 + 50 * i + 36), positions[body().faces[i].c]);
  }
  EXPECT_NE(positions[0], body().masses[0]);  // it has moved
}

TEST_F(LiveExport, ReplacesFilesOnlyOnRequestAndSaysWhatCannotBeUsed) {
  write("robot.mtl", "mine");
  const SaveResult exists = scene_.exports().pose(robot_, path("robot.obj"));
  EXPECT_EQ(exists.outcome, SaveResult::Outcome::exists);
  EXPECT_THAT(exists.files, ElementsAre(path("robot.mtl")));
  EXPECT_THAT(listing(), ElementsAre("robot.mtl"));
  EXPECT_TRUE(scene_.exports().pose(robot_, path("robot.obj"), true).ok());
  EXPECT_THAT(scene_.exports().pose(robot_, path("robot.gif")).message, HasSubstr("give obj, "));
  EXPECT_THAT(scene_.exports().pose(robot_, path("robot.pc2")).message, HasSubstr("pc2 holds a motion"));
  EXPECT_THAT(scene_.exports().motion({robot_}, path("robot.stl"), 1).message, HasSubstr("stl holds one pose"));
  EXPECT_THAT(scene_.exports().motion({robot_}, path("robot.usda"), 0).message, HasSubstr("above 0"));
  EXPECT_THAT(scene_.exports().pose(robot_ + 100, path("robot.stl")).message, HasSubstr("no longer there"));
}

TEST_F(LiveExport, MotionIsThatOfASimulationFromTimeZero) {
  scene_.time().step(30);  // the motion begins at 0 whatever the window shows
  ASSERT_TRUE(scene_.exports().motion({robot_}, path("swim.pc2"), 0.2).ok());
  EXPECT_EQ(last_message(), "exported " + path("swim.pc2"));
  EXPECT_THAT(listing(), ElementsAre("swim.mtl", "swim.obj", "swim.pc2"));  // and no recording
  std::vector<std::uint16_t> skin;
  for (std::uint16_t mass = 0; mass < body().masses.size(); ++mass)
    if (std::ranges::any_of(body().faces, [&](const Face& f) { return f.a == mass || f.b == mass || f.c == mass; }))
      skin.push_back(mass);
  const std::string pc2 = read("swim.pc2");
  const std::size_t frames = 7;  // at 0, 33 1/3, 66 2/3, ..., 200 steps of 0.001 s
  ASSERT_EQ(pc2.size(), 32 + frames * skin.size() * sizeof(Vec3));
  Simulation simulation(scene_.document().configuration, std::vector{body()});
  std::size_t place = 32;
  for (std::size_t frame = 0; frame < frames; ++frame) {
    simulation.step(static_cast<std::int64_t>(100 * frame / 3) - simulation.steps());
    const State before = simulation.state(0);
    simulation.step(1);
    const State after = simulation.state(0);
    const float share = static_cast<float>(frame % 3) / 3;
    for (const std::uint16_t mass : skin) {
      const Vec3 found = vector_at(pc2, place),
                 expected = before.positions[mass] + share * (after.positions[mass] - before.positions[mass]);
      if (frame % 3 == 0)
        ASSERT_EQ(found, before.positions[mass]) << frame;
      else
        ASSERT_LT(length(found - expected), 1e-6f) << frame;
      place += sizeof(Vec3);
    }
  }
}

TEST_F(LiveExport, AWebPageHoldsAllRobots) {
  const std::vector<RobotId> both = test::ids_of(scene_);
  EXPECT_THAT(scene_.exports().motion(both, path("both.pc2"), 0.2).message, HasSubstr("a pc2 file holds one robot"));
  ASSERT_TRUE(scene_.exports().motion(both, path("both.html"), 0.2).ok());
  EXPECT_EQ(last_message(), "exported " + path("both.html"));
  const std::string page = read("both.html");
  for (const RobotId robot : both)
    EXPECT_THAT(page, HasSubstr("\"name\":\"" + scene_.document().find(robot)->body.name + "\""));
}

TEST_F(LiveExport, ARunIsExportedByTheProgram) {
  write("program",
        "#!/bin/sh\nfor word; do case $word in --output=*) echo \"$@\" > \"${word#--output=}\";; esac; done\n");
  std::filesystem::permissions(path("program"), std::filesystem::perms::owner_all);
  ASSERT_TRUE(scene_.exports().run(path("run"), {"--map"}, path("map.html"), false, path("program")).ok());
  EXPECT_EQ(last_message(), "exported " + path("map.html"));
  EXPECT_EQ(read("map.html"), "export " + path("run") + " --output=" + path("map.html") + " --force --quiet --map\n");
  EXPECT_EQ(scene_.exports().run(path("run"), {}, path("map.html"), false, path("program")).outcome,
            SaveResult::Outcome::exists);
  write("program", "#!/bin/sh\necho 'mercury: run: there is no run' >&2; exit 2\n");
  ASSERT_TRUE(scene_.exports().run(path("run"), {}, path("other.html"), false, path("program")).ok());
  EXPECT_EQ(last_message(), "run: there is no run");
}

TEST_F(LiveExport, CanceledMotionLeavesNothingBehind) {
  ASSERT_TRUE(scene_.exports().motion({robot_}, path("swim.usda"), 1000).ok());
  scene_.cancel_work(scene_.work().front().id);
  EXPECT_EQ(last_message(), "");
  EXPECT_TRUE(listing().empty());
}

TEST_F(LiveExport, FailedMotionIsReported) {
  ASSERT_TRUE(scene_.exports().motion({robot_}, path("swim.glb"), 9).ok());
  EXPECT_THAT(last_message(), HasSubstr("are too many for a .glb file"));
  EXPECT_TRUE(listing().empty());
}

}  // namespace
}  // namespace mercury
