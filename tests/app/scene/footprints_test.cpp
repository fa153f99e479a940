// SPDX-License-Identifier: Apache-2.0
// Which parts of a robot press into the sand, and what is known of its prints at each moment.
#include "app/scene/footprints.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "app/scene/scene_details.h"
#include "mercury/voxel.h"

namespace mercury::test {
namespace {

Robot cube() { return make_voxel_robot(VoxelGrid(1, 1, 1, 3)); }  // its edges are 0.1 m

GroundContacts contacts_of(const Robot& robot, const std::vector<Vec3>& positions) {
  const Simulation simulation({.environment = Land{}}, std::span(&robot, 1));
  return FootprintObserver(simulation).contacts(positions, simulation.telemetry());
}

// The area of the contacts' triangles [m2].
float area_of(const GroundContacts& contacts) {
  float sum = 0;
  for (const GroundContact& part : contacts.parts) {
    const render::Vector2 u = part.corners[1] - part.corners[0], v = part.corners[2] - part.corners[0];
    sum += 0.5f * std::abs(u.x * v.y - u.y * v.x);
  }
  return sum;
}

TEST(FootprintObserver, ACubeOnTheGroundTouchesItWithItsLowerSide) {
  const Robot robot = cube();
  float lowest = 1;
  for (const Vec3& mass : robot.masses) lowest = std::min(lowest, mass.z);
  std::vector<Vec3> positions = robot.masses;
  for (Vec3& position : positions) position.z -= lowest;
  const GroundContacts contacts = contacts_of(robot, positions);
  EXPECT_NEAR(area_of(contacts), 0.01f, 1e-6f);
  for (const GroundContact& part : contacts.parts) {
    EXPECT_EQ(part.body, 0u);
    EXPECT_EQ(part.depth, 1);
    EXPECT_NEAR(part.radius, 0.03f, 1e-5f) << "of edges, not of diagonals";
  }
  for (Vec3& position : positions) position.z += 0.01f;
  EXPECT_TRUE(contacts_of(robot, positions).parts.empty());
}

TEST(FootprintObserver, AnEdgeAndAMassTouchTheGroundWithLess) {
  const Robot robot = cube();
  std::vector<Vec3> positions(robot.masses.size(), Vec3{0, 0, 1});
  positions[robot.faces[0].a] = {2, 3, 0};
  GroundContacts contacts = contacts_of(robot, positions);
  ASSERT_EQ(contacts.parts.size(), 1u);
  EXPECT_EQ(contacts.parts[0].corners[2], (render::Vector2{2, 3}));
  const float of_mass = contacts.parts[0].depth;
  positions[robot.faces[0].b] = {2.1f, 3, 0};
  contacts = contacts_of(robot, positions);
  ASSERT_EQ(contacts.parts.size(), 1u) << "an edge of two faces counts once";
  EXPECT_EQ(area_of(contacts), 0);
  EXPECT_GT(contacts.parts[0].depth, of_mass);
  EXPECT_LT(contacts.parts[0].depth, 1);
}

TEST(DetailObserver, LooksForFootprintsAtTheSameStepsWhereverFramesAre) {
  const Robot robot = cube();
  Simulation simulation({.environment = Land{}}, std::span(&robot, 1));
  DetailObserver observer(simulation, {});
  std::vector<double> times;
  const auto take = [&] {
    for (const GroundContacts& contacts : observer.observe(simulation.telemetry()).contacts)
      times.push_back(contacts.time);
  };
  take();
  for (const std::int64_t frame : {20, 50, 51, 70}) {
    while (*observer.next_look() < frame) {
      simulation.step(*observer.next_look() - simulation.steps());
      observer.look(simulation.telemetry());
    }
    simulation.step(frame - simulation.steps());
    take();
  }
  ASSERT_EQ(times.size(), 5u);
  for (std::size_t i = 0; i < times.size(); ++i) EXPECT_NEAR(times[i], 0.017 * static_cast<double>(i), 1e-9);
  EXPECT_FALSE(DetailObserver(simulation, {.footprints = false}).next_look());
  const Simulation in_water({.environment = Ocean{}}, std::span(&robot, 1));
  EXPECT_FALSE(DetailObserver(in_water, {}).next_look());
}

// A foot that steps to x = 0, 1, 2, ... at each whole second and is lifted half a second later.
class Walk {
 public:
  void go_to(double time, Later later = Later::forget) {
    prints_.go_to(time, later);
    for (double at = 0; at <= time; at += 0.1) {
      const double x = std::floor(at + 1e-6);
      if (at - x < 0.55) {
        const render::Vector2 place(static_cast<float>(x), 0);
        prints_.touch(at, {.part = 7, .corners = {place, place, place}, .radius = 0.03f});
      }
      prints_.know_until(at);
    }
  }
  // Where there are prints, by x, and how deep.
  std::vector<std::pair<float, float>> shown() const {
    std::vector<render::Print> prints;
    prints_.show({10, 0}, prints);
    std::vector<std::pair<float, float>> all;
    for (const render::Print& print : prints) all.emplace_back(print.corners[0].x - 10, print.depth);
    return all;
  }
  Footprints& prints() { return prints_; }

 private:
  Footprints prints_;
};

TEST(Footprints, EachStepLeavesOnePrint) {
  Walk walk;
  walk.go_to(3.2);
  const auto shown = walk.shown();
  ASSERT_EQ(shown.size(), 4u);
  for (std::size_t i = 0; i < 4; ++i) {
    EXPECT_EQ(shown[i].first, static_cast<float>(i));
    EXPECT_EQ(shown[i].second, 1);
  }
}

TEST(Footprints, FadeAfterTheFootWasLifted) {
  Walk walk;
  walk.go_to(Footprints::gone_after + 0.4);
  EXPECT_EQ(walk.shown().front().first, 0);
  EXPECT_LT(walk.shown().front().second, 0.02f);
  walk.go_to(Footprints::gone_after + 0.6);
  EXPECT_EQ(walk.shown().front().first, 1) << "lifted at 0.5 s";
  // Half of the time in which it fades has passed.
  Walk other;
  other.go_to(0.5 + 0.5 * (Footprints::whole_for + Footprints::gone_after));
  EXPECT_NEAR(other.shown().front().second, 0.5f, 1e-3f);
}

TEST(Footprints, AnEarlierMomentShowsWhatItShowedThen) {
  Walk played;
  played.go_to(14.25);
  const auto then = played.shown();
  Walk walk;
  walk.go_to(40);
  const auto now = walk.shown();
  walk.go_to(14.25, Later::keep);
  EXPECT_EQ(walk.shown(), then);
  walk.go_to(40, Later::skip);
  EXPECT_EQ(walk.shown(), now);
}

TEST(Footprints, WhatCameLaterIsForgottenWhenTheRobotGoesOnFromThere) {
  Walk walk;
  walk.go_to(9);
  walk.prints().go_to(4.2, Later::keep);
  walk.prints().go_to(4.3, Later::forget);
  EXPECT_EQ(walk.shown().size(), 5u);
  walk.prints().go_to(9, Later::forget);
  EXPECT_EQ(walk.shown().size(), 5u) << "the steps to 5 to 9 have not happened";
}

// Two feet slide 1 m to the front and back. On the way back the sand is pressed already.
TEST(Footprints, AFootThatSlidesOverItsPrintsLeavesNoOthers) {
  Footprints prints;
  double time = 0;
  const auto slide_to = [&](int step) {
    for (std::uint32_t foot = 0; foot < 2; ++foot) {
      const render::Vector2 place(0.0251f * static_cast<float>(step) + static_cast<float>(foot), 0.01f);
      prints.touch(time, {.part = foot, .corners = {place, place, place}, .radius = 0.03f});
    }
    prints.know_until(time);
    time += 0.05;
  };
  const auto count = [&] {
    prints.go_to(time, Later::keep);
    std::vector<render::Print> shown;
    prints.show({}, shown);
    return shown.size();
  };
  for (int step = 0; step < 30; ++step) slide_to(step);
  EXPECT_EQ(count(), 60u);
  for (int step = 30; step-- > 0;) slide_to(step);
  EXPECT_EQ(count(), 60u);
  time += Footprints::whole_for + 1;  // the wind has blown
  slide_to(15);
  EXPECT_EQ(count(), 62u);
}

TEST(Footprints, OfLargeGroupsEachRobotHasFewer) {
  for (const std::size_t robots : {1u, 100u, 1000u}) {
    Footprints prints(robots);
    for (int i = 0; i < 10'000; ++i) {
      const render::Vector2 place(static_cast<float>(i), 0);
      prints.touch(1e-3 * i, {.part = 7, .corners = {place, place, place}, .radius = 0.03f});
    }
    prints.go_to(10, Later::keep);
    std::vector<render::Print> shown;
    prints.show({}, shown);
    EXPECT_LE(shown.size(), std::max(Footprints::most_of_group / robots, Footprints::least));
    EXPECT_GT(shown.size(), 300u);
  }
}

TEST(Footprints, OfTooManyTheOldestAreForgotten) {
  Footprints prints;
  const int count = 3 * static_cast<int>(Footprints::most);
  for (int i = 0; i < count; ++i) {
    const render::Vector2 place(static_cast<float>(i), 0);
    prints.touch(1e-3 * i, {.part = 7, .corners = {place, place, place}, .radius = 0.03f});
  }
  prints.go_to(1e-3 * count, Later::keep);
  std::vector<render::Print> shown;
  prints.show({}, shown);
  EXPECT_LE(shown.size(), Footprints::most);
  EXPECT_GT(shown.size(), Footprints::most / 2);
  EXPECT_EQ(shown.back().corners[0].x, static_cast<float>(count - 1));
}

}  // namespace
}  // namespace mercury::test
