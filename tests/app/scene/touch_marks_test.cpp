// SPDX-License-Identifier: Apache-2.0
#include "app/scene/touch_marks.h"

#include <gtest/gtest.h>

#include <vector>

#include "mercury/voxel.h"

namespace mercury::test {
namespace {

// A cube of one voxel with sensors of touch.
Robot cube(std::vector<Sensor> sensors) {
  VoxelGrid grid(1, 1, 1, 3);
  Robot robot = make_voxel_robot(grid);
  robot.sensors = std::move(sensors);
  const std::uint32_t outputs = static_cast<std::uint32_t>(actuators_of(robot).size());
  robot.brain.emplace().layers = {{.name = "motor", .neurons = outputs, .alpha = {}, .bias = {}, .inputs = {}}};
  return robot;
}

std::vector<TouchMark> marks_of(const Robot& robot, const Environment& environment,
                                const std::vector<Vec3>& positions) {
  const Simulation simulation({.environment = environment}, std::span(&robot, 1));
  return TouchObserver(simulation).marks(positions, simulation.telemetry());
}

TEST(TouchObserver, MarksTheMassesOfASensorThatAreOnTheGround) {
  const Robot whole = cube({{.kind = SensorKind::touch}});
  const std::size_t masses = whole.masses.size();
  // Two of all masses are on the ground.
  std::vector<Vec3> positions(masses, Vec3{0, 0, 1});
  positions[3] = {4, 1, 0};
  positions[5] = {6, 1, -0.01f};
  const std::vector<TouchMark> marks = marks_of(whole, Land{}, positions);
  ASSERT_EQ(marks.size(), 2u);
  for (const TouchMark& mark : marks) {
    EXPECT_EQ(mark.body, 0u);
    EXPECT_EQ(mark.center.y, 1);
    EXPECT_EQ(mark.center.z, 0);
    EXPECT_FLOAT_EQ(mark.share, 2 / static_cast<float>(masses));
    // Springs of a cube are as long as its edge, 0.1 m, up to its diagonal.
    EXPECT_GT(mark.radius, 0.05f);
    EXPECT_LT(mark.radius, 0.087f);
  }
  EXPECT_EQ(marks[0].center.x, 4);
  EXPECT_EQ(marks[1].center.x, 6);
  // A sensor of masses that are in the air has no mark; one that has one of them there is half on the ground.
  EXPECT_EQ(marks_of(cube({{.kind = SensorKind::touch, .masses = {0, 1}}}), Land{}, positions).size(), 0u);
  const auto half = marks_of(cube({{.kind = SensorKind::touch, .masses = {2, 3}}}), Land{}, positions);
  ASSERT_EQ(half.size(), 1u);
  EXPECT_EQ(half[0].share, 0.5f);
  EXPECT_EQ(half[0].center.x, 4);
}

TEST(TouchObserver, MarksNothingWithoutGroundOrTouch) {
  const Robot robot = cube({{.kind = SensorKind::touch}});
  const std::vector<Vec3> low(robot.masses.size(), Vec3{0, 0, -1});
  EXPECT_EQ(marks_of(robot, Land{}, low).size(), robot.masses.size());
  EXPECT_EQ(marks_of(robot, Ocean{}, low).size(), 0u);
  EXPECT_EQ(marks_of(cube({{.kind = SensorKind::clock, .frequency = 1}}), Land{}, low).size(), 0u);
}

}  // namespace
}  // namespace mercury::test
