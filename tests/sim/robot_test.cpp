// SPDX-License-Identifier: Apache-2.0
// The rules that a robot must obey, each with the message for a user who breaks it.
#include "mercury/robot.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <functional>
#include <limits>

#include "bodies.h"
#include "mercury/error.h"
#include "tests/refusal.h"

namespace mercury {
namespace {

constexpr float infinity = std::numeric_limits<float>::infinity();
const float nan_value = std::nanf("");

Robot sound() { return bodies::voxels({.x = 2, .y = 1, .z = 1}, {50, 0.1f, 1, 0}); }

// The message of validate() for a valid robot after `spoil`; empty if there is none.
std::string message_after(const std::function<void(Robot&)>& spoil) {
  Robot robot = sound();
  spoil(robot);
  return refusal([&] { validate(robot); });
}

TEST(RobotRules, AValidRobotPasses) {
  EXPECT_EQ(message_after([](Robot&) {}), "");
  EXPECT_EQ(message_after([](Robot& robot) { robot.springs.clear(); }), "");
  EXPECT_EQ(message_after([](Robot& robot) { robot.faces.clear(); }), "");
  EXPECT_EQ(message_after([](Robot& robot) { robot.materials.clear(); }), "");  // the 254 defaults
  EXPECT_EQ(message_after([](Robot& robot) { robot.material_names = {"air", "flesh"}; }), "");
  EXPECT_EQ(message_after([](Robot& robot) { robot.masses[0] = {1e6f, -1e6f, 0}; }), "");
  EXPECT_EQ(message_after([](Robot& robot) { robot.springs[0].rest_length = min_rest_length; }), "");
}

TEST(RobotRules, MassesAreOneToSixtyFiveThousandAndFinite) {
  EXPECT_EQ(message_after([](Robot& robot) { robot = {}; }), "/masses: a robot needs at least one mass");
  EXPECT_EQ(message_after([](Robot& robot) { robot.masses.resize(65536); }),
            "/masses: 65536 masses, at most 65535 are accepted");
  EXPECT_EQ(message_after([](Robot& robot) { robot.masses.resize(65535); }), "");
  for (const Vec3 bad : {Vec3{nan_value, 0, 0}, Vec3{0, infinity, 0}, Vec3{0, 0, -1.1e6f}})
    EXPECT_EQ(message_after([&](Robot& robot) { robot.masses[3] = bad; }),
              "/masses/3: a position must be finite and within 1e6 m of the origin");
}

TEST(RobotRules, SpringsJoinTwoDifferentMassesOfTheRobot) {
  EXPECT_EQ(message_after([](Robot& robot) { robot.springs[7].a = 912; }),
            "/springs/7: mass 912 is out of range, the robot has 12");
  EXPECT_EQ(message_after([](Robot& robot) { robot.springs[7].b = 12; }),
            "/springs/7: mass 12 is out of range, the robot has 12");
  EXPECT_EQ(message_after([](Robot& robot) { robot.springs[2].b = robot.springs[2].a = 4; }),
            "/springs/2: joins mass 4 to itself");
}

TEST(RobotRules, SpringsHaveAMaterialOfTheTableOtherThanAir) {
  EXPECT_EQ(message_after([](Robot& robot) { robot.springs[1].material = air; }),
            "/springs/1: material 0 is air, a spring needs another");
  EXPECT_EQ(message_after([](Robot& robot) { robot.springs[1].material = 2; }),
            "/springs/1: material 2 is out of range, the table has 2");
  EXPECT_EQ(message_after([](Robot& robot) {
              robot.materials.clear();
              robot.springs[1].material = 254;
            }),
            "/springs/1: material 254 is out of range, the table has 254");
}

TEST(RobotRules, SpringsAreAtLeastAMillimeterLong) {
  EXPECT_EQ(message_after([](Robot& robot) { robot.springs[5].rest_length = 0.0005f; }),
            "/springs/5: rest length 0.000500 m, at least 0.001 m is accepted");
  EXPECT_EQ(message_after([](Robot& robot) { robot.springs[5].rest_length = -1; }),
            "/springs/5: rest length -1.000000 m, at least 0.001 m is accepted");
  for (const float bad : {nan_value, infinity})
    EXPECT_TRUE(message_after([&](Robot& robot) {
                  robot.springs[5].rest_length = bad;
                }).starts_with("/springs/5: rest length "));
}

TEST(RobotRules, FacesHaveThreeDifferentMassesOfTheRobot) {
  EXPECT_EQ(message_after([](Robot& robot) { robot.faces[3].c = 65535; }),
            "/faces/3: mass 65535 is out of range, the robot has 12");
  EXPECT_EQ(message_after([](Robot& robot) {
              robot.faces[0] = {1, 2, 1};
            }),
            "/faces/0: a face needs three different masses");
  EXPECT_EQ(message_after([](Robot& robot) {
              robot.faces[0] = {1, 1, 2};
            }),
            "/faces/0: a face needs three different masses");
  EXPECT_EQ(message_after([](Robot& robot) {
              robot.faces[0] = {2, 1, 1};
            }),
            "/faces/0: a face needs three different masses");
}

TEST(RobotRules, MaterialsAreFewNamedAllOrNoneAndValid) {
  EXPECT_EQ(message_after([](Robot& robot) { robot.materials.resize(257); }),
            "/materials: 257 materials, at most 256 are accepted");
  EXPECT_EQ(message_after([](Robot& robot) { robot.materials.resize(256); }), "");
  EXPECT_EQ(message_after([](Robot& robot) { robot.material_names = {"air"}; }),
            "/materials: every material needs a name, or none");
  EXPECT_EQ(message_after([](Robot& robot) { robot.materials[1].stiffness = infinity; }),
            "/materials/1: stiffness must be a finite number >= 0 N/m");
  EXPECT_EQ(message_after([](Robot& robot) { robot.materials[1].amplitude = nan_value; }),
            "/materials/1: amplitude must lie between -1 and 1");
  EXPECT_EQ(message_after([](Robot& robot) { robot.materials[1].amplitude = -1; }),
            "/materials/1: amplitude must lie between -1 and 1");
  EXPECT_EQ(message_after([](Robot& robot) { robot.materials[1].frequency = infinity; }),
            "/materials/1: frequency must be a finite number of rad/s");
  EXPECT_EQ(message_after([](Robot& robot) { robot.materials[1].phase = nan_value; }),
            "/materials/1: phase must be a finite number of rad");
}

TEST(Robots, RestDistanceIsThatOfThePositions) {
  Robot robot;
  robot.masses = {{1, 2, 3}, {3, 5, 9}};
  EXPECT_FLOAT_EQ(rest_distance(robot, 0, 1), 7);
  EXPECT_FLOAT_EQ(rest_distance(robot, 1, 0), 7);
}

TEST(Robots, WithoutATableTheMaterialsAreTheDefaults) {
  Robot robot = sound();
  EXPECT_EQ(materials_of(robot).size(), 2u);
  robot.materials.clear();
  EXPECT_EQ(materials_of(robot).data(), default_materials().data());
}

// Springs of three materials, the third one passive.
Robot with_muscles() {
  Robot robot = sound();
  robot.masses = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 0}};
  robot.faces.clear();
  robot.materials = {{}, {50, 0.1f, 3, 1}, {60, 0.2f, 3, 2}, {70, 0, 0, 0}, {80, 0.3f, 3, 1}};
  robot.material_names = {"air", "flexor", "extensor", "bone", "stiff flexor"};
  robot.springs = {{0, 1, 1, 1}, {0, 2, 2, 1}, {1, 3, 3, 1}, {2, 3, 1, 1}, {0, 3, 4, 1.4f}};
  return robot;
}

TEST(Actuators, OfARobotThatNamesNoneAreItsMusclesThatMoveAlike) {
  const std::vector<Actuator> found = actuators_of(with_muscles());
  ASSERT_EQ(found.size(), 2u);
  EXPECT_EQ(found[0], (Actuator{.name = "flexor", .materials = {1, 4}}));
  EXPECT_EQ(found[1], (Actuator{.name = "extensor", .materials = {2}}));
}

TEST(Actuators, OfMaterialsThatNoSpringHasDoNotExist) {
  Robot robot = with_muscles();
  robot.springs.resize(1);
  ASSERT_EQ(actuators_of(robot).size(), 1u);
  EXPECT_EQ(actuators_of(robot)[0].materials, std::vector<MaterialId>{1});
}

TEST(Actuators, ThatARobotNamesAreItsActuators) {
  Robot robot = with_muscles();
  robot.actuators = {{.name = "all", .materials = {3, 1}}};
  EXPECT_EQ(actuators_of(robot), robot.actuators);
}

// Spring 3 has the material of spring 0, so spring 0 needs a copy of it. No other spring has that of spring 1.
TEST(Actuators, GetMaterialsThatNoOtherSpringHas) {
  Robot robot = with_muscles();
  add_actuator(robot, "corner", std::array{0u, 1u, 0u});
  validate(robot);
  ASSERT_EQ(robot.actuators.size(), 1u);
  EXPECT_EQ(robot.actuators[0], (Actuator{.name = "corner", .materials = {5, 2}}));
  EXPECT_EQ(robot.materials[5], robot.materials[1]);
  EXPECT_EQ(robot.material_names[5], "flexor");
  const std::vector<MaterialId> expected = {5, 2, 3, 1, 4};
  for (std::size_t i = 0; i < expected.size(); ++i) EXPECT_EQ(robot.springs[i].material, expected[i]) << i;
}

TEST(Actuators, GiveARobotWithTheDefaultTableOneOfItsOwn) {
  Robot robot = with_muscles();
  robot.materials.clear();
  robot.material_names.clear();
  add_actuator(robot, "a", std::array{0u});
  add_actuator(robot, "b", std::array{1u, 2u});
  validate(robot);
  EXPECT_EQ(robot.materials.size(), 6u) << "air, the four that springs have, and a copy of material 1";
  for (std::size_t i = 0; i < robot.springs.size(); ++i)
    EXPECT_EQ(robot.materials[robot.springs[i].material], default_materials()[with_muscles().springs[i].material]) << i;
}

std::string message_of_actuator(Robot robot, const std::vector<std::uint32_t>& springs) {
  const Robot before = robot;
  const std::string message = refusal([&] { add_actuator(robot, "fin", springs); });
  EXPECT_TRUE(message.empty() || robot == before) << "changed by an error";
  return message;
}

TEST(Actuators, ThatCannotBeMadeAreRefused) {
  Robot robot = with_muscles();
  EXPECT_EQ(message_of_actuator(robot, {5}), "actuator fin: spring 5 is out of range, the robot has 5");
  add_actuator(robot, "corner", std::array{1u});
  EXPECT_EQ(message_of_actuator(robot, {1}), "actuator fin: springs of material 2 have an actuator already");
  EXPECT_EQ(message_of_actuator(robot, {}), "/actuators/1: an actuator needs at least one material or spring");
}

TEST(Actuators, NeedRoomInATableThatSpringsUseWhole) {
  Robot robot;
  robot.materials.resize(max_materials, {50, 0.1f, 1, 0});
  for (int i = 0; i <= max_materials; ++i) robot.masses.push_back({static_cast<float>(i), 0, 0});
  for (std::uint16_t i = 0; i < max_materials; ++i)
    robot.springs.push_back({i, static_cast<std::uint16_t>(i + 1), static_cast<MaterialId>(i == 0 ? 255 : i), 1});
  validate(robot);
  EXPECT_EQ(message_of_actuator(robot, {1}), "");
  EXPECT_EQ(message_of_actuator(robot, {0, 255}), "");
  EXPECT_EQ(message_of_actuator(robot, {0}),
            "actuator fin: needs more than 255 materials; a robot has at most 255 and air");
}

TEST(Actuators, WithNamesTwiceOrMaterialsTwiceAreRefused) {
  Robot robot = with_muscles();
  robot.actuators = {{.name = "a", .materials = {1}}, {.name = "a", .materials = {2}}};
  EXPECT_THROW(validate(robot), InputError);
  robot.actuators[1] = {.name = "b", .materials = {2, 1}};
  EXPECT_THROW(validate(robot), InputError);
  robot.actuators[1] = {.name = "b", .materials = {5}};
  EXPECT_THROW(validate(robot), InputError);
  robot.actuators[1] = {.name = "b", .materials = {air}};
  EXPECT_THROW(validate(robot), InputError);
  robot.actuators[1] = {.name = "", .materials = {2}};
  EXPECT_THROW(validate(robot), InputError);
  robot.actuators[1] = {.name = "b", .materials = {2}};
  EXPECT_NO_THROW(validate(robot));
}

}  // namespace
}  // namespace mercury
