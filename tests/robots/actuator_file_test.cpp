// SPDX-License-Identifier: Apache-2.0
// Actuators in robot files: what is read, what is written, and what is refused.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <sstream>

#include "mercury/robot_file.h"
#include "robots/file/document.h"
#include "tests/refusal.h"

namespace mercury {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::Not;

// A chain of five springs with materials 1, 2, 3, 2, 1 of the default table, and these actuators.
std::string chain(const std::string& actuators, const std::string& before = "", const std::string& after = "") {
  return "{" + before +
         R"("format":"mercury-robot","version":1,"name":"chain",)"
         R"("masses":[[0,0,0],[1,0,0],[2,0,0],[3,0,0],[4,0,0],[5,0,0]],)"
         R"("springs":[[0,1,1],[1,2,2],[2,3,3],[3,4,2],[4,5,1]],"faces":[])" +
         (actuators.empty() ? "" : ",\"actuators\":" + actuators) + after + "}";
}

class ActuatorsInFiles : public testing::TestWithParam<RobotFormat> {
 protected:
  static std::string document(const std::string& json) {
    if (GetParam() == RobotFormat::json) return json;
    std::string cbor;
    CborWriter writer(cbor);
    read_json(json, writer);
    return cbor;
  }
  static Robot read(const std::string& json) { return parse_robot(document(json), GetParam()); }
  static Robot again(const Robot& robot) { return parse_robot(serialize_robot(robot, GetParam()), GetParam()); }
  static std::string refusal(const std::string& json) {
    return mercury::refusal([&] { read(json); });
  }
  static std::string refusal_of(const std::string& actuators) { return refusal(chain(actuators)); }
};
INSTANTIATE_TEST_SUITE_P(Formats, ActuatorsInFiles, testing::Values(RobotFormat::json, RobotFormat::cbor),
                         [](const auto& format) { return format.param == RobotFormat::json ? "json" : "cbor"; });

std::vector<int> materials_of_springs(const Robot& robot) {
  std::vector<int> materials;
  for (const Spring& spring : robot.springs) materials.push_back(spring.material);
  return materials;
}

TEST_P(ActuatorsInFiles, GroupsOfMaterialsKeepTheirOrderAndTheDefaultTable) {
  const Robot robot = read(chain(R"([{"name":"middle","materials":[3]},{"materials":[2,1],"name":"ends"}])"));
  EXPECT_TRUE(robot.materials.empty());
  EXPECT_THAT(robot.actuators, ElementsAre(Actuator{"middle", {3}}, Actuator{"ends", {2, 1}}));
  EXPECT_EQ(again(robot), robot);
}

TEST_P(ActuatorsInFiles, GroupsOfSpringsGetMaterialsOfTheirOwn) {
  const Robot robot = read(chain(R"([{"name":"head","springs":[0,1]},{"name":"tail","springs":[4,3,4]}])"));
  // Muscles 1 and 2 have springs inside and outside the head, so the head's are copies: air, 1, 2, 3, then 4 and 5.
  EXPECT_EQ(materials_of_springs(robot), (std::vector{4, 5, 3, 2, 1}));
  EXPECT_THAT(robot.actuators, ElementsAre(Actuator{"head", {4, 5}}, Actuator{"tail", {1, 2}}));
  ASSERT_EQ(robot.materials.size(), 6u);
  EXPECT_EQ(robot.materials[4], default_materials()[1]);
  EXPECT_EQ(robot.materials[5], default_materials()[2]);
  EXPECT_THAT(robot.material_names, ElementsAre("air", "muscle 1", "muscle 2", "muscle 3", "muscle 1", "muscle 2"));
  EXPECT_EQ(again(robot), robot);
}

TEST_P(ActuatorsInFiles, SpringsAndMaterialsMayBeMixedInAnyOrder) {
  const std::string actuators = R"([{"name":"head","springs":[0]},{"name":"twos","materials":[2]}])";
  const Robot robot = read(chain(actuators));
  EXPECT_EQ(materials_of_springs(robot), (std::vector{4, 2, 3, 2, 1}));
  EXPECT_THAT(robot.actuators, ElementsAre(Actuator{"head", {4}}, Actuator{"twos", {2}}));
  // The key may come first in the document.
  EXPECT_EQ(read(chain("", "\"actuators\":" + actuators + ",")), robot);
}

TEST_P(ActuatorsInFiles, ARobotWithoutActuatorsIsWrittenAsBefore) {
  const Robot robot = read(chain(""));
  EXPECT_EQ(read(chain("[]")), robot);
  EXPECT_THAT(serialize_robot(robot, GetParam()), Not(HasSubstr("actuators")));
}

TEST(ActuatorsInJson, ARobotWithoutActuatorsIsTheDocumentOfOlderVersions) {
  EXPECT_EQ(serialize_robot({.name = "one", .masses = {{0, 0, 0}}}, RobotFormat::json),
            "{\n\"format\":\"mercury-robot\",\n\"version\":1,\n\"name\":\"one\",\n\"masses\":[[0,0,0]],\n"
            "\"springs\":[],\n\"faces\":[]\n}\n");
}

TEST_P(ActuatorsInFiles, UnknownKeysAreIgnored) {
  const Robot robot = read(chain(
      R"([{"color":{"r":[1,{"materials":[0]}]},"name":"a","limit":null,"materials":[1],"x":[[],"y"],"z":true}])"));
  EXPECT_THAT(robot.actuators, ElementsAre(Actuator{"a", {1}}));
}

TEST_P(ActuatorsInFiles, WhatBreaksARuleIsNamedWithItsPlace) {
  EXPECT_EQ(refusal_of("{}"), "/actuators: must be an array, not an object");
  EXPECT_EQ(refusal_of("7"), "/actuators: must be an array, not a number");
  EXPECT_EQ(refusal_of("[7]"), "/actuators: holds a number at 0, not an object");
  EXPECT_EQ(refusal_of("[[]]"), "/actuators: holds an array at 0, not an object");
  EXPECT_EQ(refusal_of("[null]"), "/actuators: holds null at 0, not an object");
  EXPECT_EQ(refusal_of(R"([{"materials":[1]}])"), "/actuators/0: name is missing");
  EXPECT_EQ(refusal_of(R"([{"name":"","materials":[1]}])"),
            "/actuators/0/name: an actuator needs a name, without NUL characters");
  EXPECT_EQ(refusal_of(R"([{"name":"a\u0000","materials":[1]}])"),
            "/actuators/0/name: an actuator needs a name, without NUL characters");
  EXPECT_EQ(refusal_of(R"([{"name":3,"materials":[1]}])"), "/actuators/0/name: must be a text, not a number");
  EXPECT_EQ(refusal_of(R"([{"name":["a"],"materials":[1]}])"), "/actuators/0/name: must be a text, not an array");
  EXPECT_EQ(refusal_of(R"([{"name":"a","materials":[1]},{"name":"a","materials":[2]}])"),
            "/actuators/1/name: is the name of actuator 0");
  EXPECT_EQ(refusal_of(R"([{"name":"a"}])"), "/actuators/0: has neither materials nor springs; give one of them");
  EXPECT_EQ(refusal_of(R"([{"name":"a","materials":[1],"springs":[2]}])"),
            "/actuators/0: has both materials and springs; give one of them");
  EXPECT_EQ(refusal_of(R"([{"name":"a","name":"b","materials":[1]}])"), "/actuators/0/name: appears twice");
  EXPECT_EQ(refusal(chain("[]", R"("actuators":[],)")), "/actuators: appears twice");
}

TEST_P(ActuatorsInFiles, MaterialsThatDoNotFitAreNamed) {
  const auto materials = [](const std::string& list) {
    return refusal_of(R"([{"name":"a","materials":[1]},{"name":"b","materials":)" + list + "}]");
  };
  EXPECT_EQ(materials("[2]"), "");
  EXPECT_EQ(materials("[]"), "/actuators/1: an actuator needs at least one material or spring");
  EXPECT_EQ(materials("3"), "/actuators/1/materials: must be an array, not a number");
  EXPECT_EQ(materials("[[1]]"), "/actuators/1/materials: must hold whole numbers, not an array");
  EXPECT_EQ(materials("[\"1\"]"), "/actuators/1/materials: must hold whole numbers, not a text");
  EXPECT_EQ(materials("[{}]"), "/actuators/1/materials: must hold whole numbers, not an object");
  EXPECT_EQ(materials("[1.5]"), "/actuators/1/materials: a material is given by a whole number");
  EXPECT_EQ(materials("[-1]"), "/actuators/1/materials: material -1 is out of range");
  EXPECT_EQ(materials("[0]"), "/actuators/1/materials: material 0 is air, an actuator needs others");
  EXPECT_EQ(materials("[254]"), "/actuators/1/materials: material 254 is out of range, the table has 254");
  EXPECT_EQ(materials("[256]"), "/actuators/1/materials: material 256 is out of range, a table has up to 256");
  EXPECT_EQ(materials("[2,1]"), "/actuators/1/materials: material 1 is named twice among the actuators");
  EXPECT_EQ(materials("[2,2]"), "/actuators/1/materials: material 2 is named twice among the actuators");
}

TEST_P(ActuatorsInFiles, SpringsThatDoNotFitAreNamed) {
  const auto springs = [](const std::string& list) {
    return refusal_of(R"([{"name":"a","springs":[0]},{"name":"b","materials":[3]},{"name":"c","springs":)" + list +
                      "}]");
  };
  EXPECT_EQ(springs("[1]"), "");
  EXPECT_EQ(springs("[]"), "/actuators/2: an actuator needs at least one material or spring");
  EXPECT_EQ(springs("[912]"), "/actuators/2/springs: spring 912 is out of range, the robot has 5");
  EXPECT_EQ(springs("[18446744073709551615]"),
            "/actuators/2/springs: spring 18446744073709551615 is out of range, the robot has 5");
  EXPECT_EQ(springs("[-2]"), "/actuators/2/springs: spring -2 is out of range");
  EXPECT_EQ(springs("[0.5]"), "/actuators/2/springs: a spring is given by a whole number");
  EXPECT_EQ(springs("[1,0]"), "/actuators/2/springs: spring 0 belongs to actuator 0");
  EXPECT_EQ(springs("[2]"), "/actuators/2/springs: spring 2 belongs to actuator 1");
}

// A robot of springs of one material at one mass, of which the first ones have actuators of their own.
std::string star(int springs, int actuators) {
  std::ostringstream masses, rows, named;
  for (int i = 0; i < springs; ++i) {
    masses << ",[" << i + 1 << ",0,0]";
    rows << (i > 0 ? "," : "") << "[0," << i + 1 << ",1]";
  }
  for (int i = 0; i < actuators; ++i)
    named << (i > 0 ? "," : "") << R"({"name":"n)" << i << R"(","springs":[)" << i << "]}";
  std::ostringstream document;
  document << R"({"format":"mercury-robot","version":1,"faces":[],"masses":[[0,0,0])" << masses.str()
           << R"(],"springs":[)" << rows.str() << R"(],"actuators":[)" << named.str() << "]}";
  return document.str();
}

TEST_P(ActuatorsInFiles, MoreActuatorsThanMaterialsAreRefused) {
  // The last of 255 keeps the material that the others leave; with one more spring there is none left for it.
  EXPECT_EQ(refusal(star(255, 255)), "");
  EXPECT_EQ(refusal(star(256, 255)),
            "/actuators/254/springs: its springs need materials of their own, and the robot would have more than 255");
  EXPECT_THAT(refusal(star(256, 256)), HasSubstr("at most 255 are accepted"));
}

TEST(AddActuator, AFullTableLosesMaterialsThatNoSpringHas) {
  const auto defaults = default_materials();
  Robot robot{.masses = {{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {3, 0, 0}, {4, 0, 0}}};
  robot.materials.assign(defaults.begin(), defaults.end());
  robot.materials.resize(max_materials, {7, 0.1f, 1, 2});
  robot.material_names.assign(robot.materials.size(), "");
  robot.material_names[200] = "fin";
  robot.springs = {{0, 1, 200, 1}, {1, 2, 200, 1}, {2, 3, 255, 1}, {3, 4, 255, 1}};
  robot.actuators = {{"rest", {9, 255}}};
  add_actuator(robot, "first", std::vector<std::uint32_t>{0});
  EXPECT_EQ(materials_of_springs(robot), (std::vector{4, 2, 3, 3}));
  EXPECT_EQ(robot.materials,
            (std::vector{Material{}, defaults[9], defaults[200], Material{7, 0.1f, 1, 2}, defaults[200]}));
  EXPECT_THAT(robot.material_names, ElementsAre("", "", "fin", "", "fin"));
  EXPECT_THAT(robot.actuators, ElementsAre(Actuator{"rest", {1, 3}}, Actuator{"first", {4}}));
}

TEST(ActuatorsInCbor, NothingIsAllocatedForActuatorsThatAreOnlyAnnounced) {
  using namespace std::string_literals;
  const auto refusal = [](const std::string& cbor) {
    return mercury::refusal([&] { parse_robot(cbor, RobotFormat::cbor); });
  };
  EXPECT_EQ(refusal("\xa1\x69"s + "actuators\x9a\x00\x0f\x42\x40"s),
            "/actuators: 1000000 actuators, at most 255 are accepted");
  EXPECT_EQ(refusal("\xa1\x69"s + "actuators\x81\xa1\x67springs\x9b\x00\x00\x00\xff\xff\xff\xff\xff"s),
            "byte 21: the CBOR document breaks off");
}

}  // namespace
}  // namespace mercury
