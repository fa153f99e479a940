// SPDX-License-Identifier: Apache-2.0
// Robots that stay in their cells or lanes, and robots that have exploded.
#include "app/scene/group_motion.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "app/scene/group_scene.h"

namespace mercury::test {
namespace {

using render::Vector3;

Trail moved(Vec3 from, Vec3 to) {
  Trail trail(from);
  trail.pass(to);
  return trail;
}

GroupMotion motion(Layout layout, const Environment& environment = Ocean{}) {
  GroupMotion motion;
  motion.set(layout, environment, {1, 0, 0});
  return motion;
}

TEST(Cells, TheCenterOfMassStaysInTheMiddleOfItsCell) {
  const Room room{{1, 2, 3}, 1};
  const Vector3 offset(10, 20, 30);
  for (const Vec3 place : {Vec3{1, 2, 3}, Vec3{-40, 7, 900}, Vec3{1e4f, 0, 0}}) {
    const Vector3 shown = Vector3(place) + motion(Layout::cells).offset_of(offset, room, moved({1, 2, 3}, place));
    EXPECT_LT((shown - Vector3(11, 22, 33)).norm(), 1e-3f);
  }
}

TEST(Cells, OnLandHeightsDoNotChange) {
  const Vector3 offset = motion(Layout::cells, Land{}).offset_of({4, 5, 0}, {{0, 0, 1}, 1}, moved({}, {3, 3, 0.2f}));
  EXPECT_EQ(offset.z, 0);
  EXPECT_LT((offset - Vector3(1, 2, 0)).norm(), 1e-5f);
}

TEST(Cells, RobotsNeverMeetWhileTheyTurnAboutTheVertical) {
  std::mt19937 random(3);
  std::uniform_real_distribution<float> size(0.2f, 2);
  for (const CameraMode mode : {CameraMode::group, CameraMode::top})
    for (const Environment& environment : {Environment(Ocean{}), Environment(Land{})})
      for (const std::size_t count : {2u, 7u, 30u}) {
        std::vector<Room> rooms;
        std::vector<render::Bounds> boxes(count);
        for (std::size_t i = 0; i < count; ++i) {
          rooms.push_back({{size(random), size(random), 0}, size(random), size(random)});
          boxes[i].extend(rooms[i].center);
        }
        const auto offsets =
            group_offsets(boxes, rooms, {.layout = Layout::cells, .camera = {.mode = mode}}, environment, 1.78f);
        for (std::size_t a = 0; a < count; ++a)
          for (std::size_t b = 0; b < a; ++b) {
            const Vector3 apart = offsets[a] + rooms[a].center - offsets[b] - rooms[b].center;
            EXPECT_TRUE(apart.xy().norm() > rooms[a].radius + rooms[b].radius ||
                        std::abs(apart.z) > rooms[a].half_height + rooms[b].half_height);
          }
      }
}

TEST(Race, ARobotIsAsFarAlongItsLaneAsItIsFromItsStart) {
  const Room room{{0, 0, 0}, 1};
  const GroupMotion race = motion(Layout::race, Land{});
  const Trail trail = moved({1, 1, 0}, {4, 5, 2});  // 5 m along the ground
  const Vector3 shown = Vector3(trail.last()) + race.offset_of({0, 7, 0}, room, trail);
  EXPECT_NEAR(shown.x, 5, 1e-5);
  EXPECT_NEAR(shown.y, 7, 1e-5);
  EXPECT_NEAR(shown.z, 2, 1e-5) << "its height is its own";
}

TEST(HeldRobot, FollowsTheMouseAndGlidesBack) {
  HeldRobot held;
  EXPECT_EQ(held.correction(2, {1, 0, 0}), Vector3::all(0));
  held.hold(2, 0.1);
  EXPECT_LT(held.correction(2, {1, 0, 0}).norm(), 1e-6f);
  held.hold(2, 0.1);
  // Its cell wants to be shifted by -3 m, since it moved by 3 m; it does not.
  EXPECT_LT((Vector3(-2, 0, 0) + held.correction(2, {-2, 0, 0}) - Vector3(1, 0, 0)).norm(), 1e-6f);
  EXPECT_EQ(held.correction(1, {5, 0, 0}), Vector3::all(0)) << "others go on";
  float before = 3;
  for (int i = 0; i < 40; ++i) {
    held.hold({}, 0.05);
    const float now = held.correction(2, {-2, 0, 0}).norm();
    EXPECT_LT(now, std::max(before, 1e-9f));
    before = std::max(now, 0.0f);
    if (now == 0) break;
  }
  EXPECT_LT(before, 1e-3f);
}

Robot pair(const std::string& name) {
  return {.name = name, .masses = {{0, 0, 0}, {1, 0, 0}}, .springs = {{0, 1, 1, 1}}};
}

class Explosions : public testing::TestWithParam<Layout> {
 protected:
  std::vector<Robot> robots_{pair("one"), pair("two")};
  Simulation simulation_{Configuration{.device = {.kind = DeviceKind::cpu, .threads = 1}}, robots_};
  GroupScene scene_{simulation_, {{-2, 0, 0}, {2, 0, 0}}, {.layout = GetParam()}};
  std::vector<Telemetry> telemetry_ = simulation_.telemetry();

  void swim_to(std::size_t robot, Vec3 place) {
    telemetry_[robot].center_of_mass = place;
    scene_.update(1, telemetry_, {});
  }
  void explode(std::size_t robot) {
    telemetry_[robot].exploded = true;
    telemetry_[robot].center_of_mass = {3e5f, NAN, 0};
    telemetry_[robot].largest_strain = 1e5f;
    scene_.update(2, telemetry_, {});
  }
};

TEST_P(Explosions, CamerasLeaveOutARobotThatHasExploded) {
  swim_to(1, {5, 0, 0});
  explode(1);
  EXPECT_TRUE(scene_.camera_boxes()[1].empty());
  ASSERT_FALSE(scene_.camera_boxes()[0].empty());
  EXPECT_LT(scene_.camera_boxes()[0].radius(), 3);
  EXPECT_TRUE(scene_.scene().placements[1].hidden) << "what is left of it would cover everything";
  EXPECT_FALSE(scene_.scene().texts.empty()) << "but its name is there";
  scene_.mark(1, true, false);
  scene_.update(2, telemetry_, {});
  EXPECT_TRUE(scene_.scene().placements[1].hidden) << "also when it is selected: it would fill the view";
  EXPECT_FALSE(scene_.scene().texts.empty());
}

TEST_P(Explosions, IfAllHaveExplodedCamerasShowWhereTheyWereLast) {
  for (const std::size_t robot : {0u, 1u}) swim_to(robot, {static_cast<float>(6 * robot), 0.5f, 0});
  const std::vector<render::Bounds> before(scene_.camera_boxes().begin(), scene_.camera_boxes().end());
  for (const std::size_t robot : {0u, 1u}) explode(robot);
  for (const std::size_t robot : {0u, 1u}) {
    EXPECT_LT((scene_.camera_boxes()[robot].low - before[robot].low).norm(), 1e-5f);
    EXPECT_LT((scene_.camera_boxes()[robot].high - before[robot].high).norm(), 1e-5f);
  }
}

INSTANTIATE_TEST_SUITE_P(InAllLayouts, Explosions, testing::Values(Layout::grid, Layout::cells, Layout::race),
                         [](const auto& tested) { return std::string(name_of(tested.param)); });

}  // namespace
}  // namespace mercury::test
