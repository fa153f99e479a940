// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <set>
#include <vector>

#include "mercury/voxel.h"
#include "robots/importers/encodings.h"
#include "tests/robots/importers/documents.h"

namespace mercury {
namespace {

// A robot of 3 x 2 voxels (below: horizontal, soft, vertical; above: rigid, empty, horizontal), a box, and ground.
const std::string world = R"({"grid_width": 8, "grid_height": 4, "objects": {
  "robot": {"indices": [9, 10, 11, 17, 19], "types": [3, 2, 4, 1, 3],
            "neighbors": {"9": [10, 17], "10": [9, 11], "11": [10, 19], "17": [9], "19": [11]}},
  "box": {"indices": [14], "types": [2], "neighbors": {"14": []}},
  "ground": {"indices": [0, 1, 2, 3, 4, 5, 6, 7], "types": [5, 5, 5, 5, 5, 5, 5, 5], "color": "green"}}})";

Import evogym(const ImportOptions& options = {}) { return import_text(world, "evogym", "world", options); }

TEST(Evogym, RobotsAndMovableObjectsBecomeRobots) {
  const Import import = evogym();
  EXPECT_EQ(import.report.robots, (std::vector<std::string>{"world-box", "world"}));
  EXPECT_EQ(import.robots[0].masses.size(), 8u);
  EXPECT_EQ(import.robots[1].masses.size(), 24u);
  EXPECT_EQ(element_at(import.report, "/objects/ground/types")->outcome, ImportOutcome::ignored);
  EXPECT_EQ(element_at(import.report, "/objects/ground/color")->reason, "unknown");
  EXPECT_EQ(element_at(import.report, "/objects/robot/types")->outcome, ImportOutcome::mapped);
}

TEST(Evogym, RowsStandUpright) {
  const Robot robot = evogym().robots[1];
  // The gap above the soft voxel: no spring joins the corners of its upper side along x.
  std::set<std::pair<int, int>> upper;
  for (const Spring& spring : robot.springs) {
    const Vec3 &a = robot.masses[spring.a], &b = robot.masses[spring.b];
    if (a.z > 0.05f && b.z > 0.05f && a.y == b.y && a.y < 0)
      upper.emplace(std::lround(std::min(a.x, b.x) * 10 + 1.5f), std::lround(std::max(a.x, b.x) * 10 + 1.5f));
  }
  EXPECT_TRUE(upper.contains({0, 1}));
  EXPECT_TRUE(upper.contains({2, 3}));
  EXPECT_FALSE(upper.contains({1, 2}));
}

TEST(Evogym, ActuatorsMoveTheSpringsAlongTheirAxisAlone) {
  const Robot robot = evogym().robots[1];
  ASSERT_EQ(robot.actuators.size(), 3u);
  EXPECT_EQ(robot.actuators[0].name, "horizontal 0,0");
  EXPECT_EQ(robot.actuators[1].name, "vertical 2,0");
  EXPECT_EQ(robot.actuators[2].name, "horizontal 2,1");
  std::size_t muscles[3] = {};
  for (const Spring& spring : robot.springs) {
    const Vec3 &a = robot.masses[spring.a], &b = robot.masses[spring.b];
    const bool x = std::abs(a.x - b.x) > 0.05f, y = std::abs(a.y - b.y) > 0.05f, z = std::abs(a.z - b.z) > 0.05f;
    for (std::size_t i = 0; i < 3; ++i) {
      const auto& ids = robot.actuators[i].materials;
      if (std::ranges::find(ids, spring.material) == ids.end()) continue;
      ++muscles[i];
      EXPECT_FALSE(y);
      EXPECT_NE(x, z);
      EXPECT_EQ(x, i != 1);
    }
    if (y || x == z) {
      EXPECT_EQ(robot.materials[spring.material].amplitude, 0);
    }
  }
  // Four edges of a voxel run along an axis.
  EXPECT_EQ(muscles[0], 4u);
  EXPECT_EQ(muscles[1], 4u);
  EXPECT_EQ(muscles[2], 4u);
}

TEST(Evogym, ActuatorsReachTheShortestLengthOfEvogym) {
  const Robot robot = evogym().robots[1];
  for (const Actuator& actuator : robot.actuators)
    for (const MaterialId id : actuator.materials) EXPECT_FLOAT_EQ(robot.materials[id].amplitude, 0.4f);
}

// In EvoGym a shared edge has the mean of the lengths that both actuators want. Two springs of half the stiffness pull
// like one of that length.
TEST(Evogym, SharedEdgesFollowBothActuators) {
  const Robot robot = import_text(R"({"grid_width": 2, "grid_height": 1, "objects": {
      "robot": {"indices": [0, 1], "types": [4, 4], "neighbors": {"0": [1], "1": [0]}}}})",
                                  "evogym", "world")
                          .robots.at(0);
  ASSERT_EQ(robot.actuators.size(), 2u);
  std::map<std::pair<int, int>, std::vector<Spring>> upright;
  for (const Spring& spring : robot.springs)
    if (robot.materials[spring.material].amplitude != 0) upright[{spring.a, spring.b}].push_back(spring);
  ASSERT_EQ(upright.size(), 6u);
  float own = 0;
  for (const auto& [ends, springs] : upright)
    if (springs.size() == 1) own = robot.materials[springs[0].material].stiffness;
  std::size_t shared = 0;
  for (const auto& [ends, springs] : upright) {
    if (springs.size() == 1) continue;
    ++shared;
    ASSERT_EQ(springs.size(), 2u);
    EXPECT_NEAR(robot.masses[springs[0].a].x, 0, 1e-6);
    for (std::size_t i = 0; i < 2; ++i) {
      EXPECT_FLOAT_EQ(robot.materials[springs[i].material].stiffness, own / 2);
      const auto& ids = robot.actuators[i].materials;
      EXPECT_NE(std::ranges::find(ids, springs[i].material), ids.end());
    }
  }
  EXPECT_EQ(shared, 2u);
}

// PhysicsEngine.cpp: the ground pulls with at most 10 x 0.2 times the normal force; length at rest and edge start each
// step of 1e-4 s together, so that k dt / 2 resists motion beside 0.006 k that pulls to the goal.
TEST(Evogym, FrictionAndDampingAreThoseOfItsProgram) {
  const Import import = evogym();
  EXPECT_DOUBLE_EQ(import.settings.friction, 2);
  for (const Robot& robot : import.robots)
    for (std::size_t id = 1; id < robot.materials.size(); ++id)
      EXPECT_NEAR(robot.materials[id].relaxation_time, 1e-4 / 2 / 0.006 * std::sqrt(110 / 9.81), 1e-6);
}

// A diagonal across the plane is 0.3 times as stiff as one within it, of the same voxel.
TEST(Evogym, DiagonalsAcrossThePlaneAreSoft) {
  const Robot robot = import_text(R"({"grid_width": 1, "grid_height": 1, "objects": {
      "robot": {"indices": [0], "types": [3], "neighbors": {"0": []}}}})",
                                  "evogym", "world")
                          .robots.at(0);
  float within = 0, across = 0;
  for (const Spring& spring : robot.springs) {
    const Vec3 &a = robot.masses[spring.a], &b = robot.masses[spring.b];
    if (a.x != b.x && a.z != b.z && a.y == b.y) within = robot.materials[spring.material].stiffness;
    if (a.x != b.x && a.z == b.z && a.y != b.y) across = robot.materials[spring.material].stiffness;
  }
  EXPECT_GT(within, 0);
  EXPECT_FLOAT_EQ(across, 0.3f * within);
}

TEST(Evogym, DepthExtrudes) {
  const Import import = evogym({.depth = 3});
  EXPECT_EQ(import.robots[0].masses.size(), 4u * 4);
  EXPECT_EQ(import.robots[1].masses.size(), 12u * 4);
  EXPECT_EQ(import.robots[1].actuators.size(), 3u);
}

TEST(Evogym, MissingConnectionsAreReported) {
  std::string text = world;
  text.replace(text.find("\"9\": [10, 17], \"10\": [9, 11]"), 28, "\"9\": [17], \"10\": [11]");
  const Import import = import_text(text, "evogym", "world");
  EXPECT_EQ(element_at(import.report, "/objects/robot/neighbors")->outcome, ImportOutcome::approximated);
}

TEST(Evogym, FixedVoxelsHoldARobot) {
  std::string text = world;
  text.replace(text.find("[3, 2, 4, 1, 3]"), 15, "[5, 2, 4, 1, 3]");
  const Import import = import_text(text, "evogym", "world");
  const Robot& robot = import.robots[1];
  // The corners of the voxel at the lower left.
  EXPECT_EQ(robot.fixed.size(), 8u);
  for (std::size_t mass = 0; mass < robot.masses.size(); ++mass)
    EXPECT_EQ(std::ranges::count(robot.fixed, mass), robot.masses[mass].x < 0 && robot.masses[mass].z < 0.05f ? 1 : 0);
  EXPECT_NE(import.report.decisive.at(0).find("held in its place"), std::string::npos);
}

// Diagonals do not move, and belong to one voxel: they have the name of its actuator, which colors the skin.
TEST(Evogym, DiagonalsHaveTheNameOfTheirActuator) {
  const Robot robot = evogym().robots[1];
  std::size_t named = 0;
  for (const Spring& spring : robot.springs) {
    const Material& material = robot.materials[spring.material];
    const Vec3 &a = robot.masses[spring.a], &b = robot.masses[spring.b];
    const bool is_face_diagonal = a.y == b.y && a.x != b.x && a.z != b.z;
    if (!is_face_diagonal) continue;
    EXPECT_EQ(material.amplitude, 0);
    const float x = (a.x + b.x) / 2, z = (a.z + b.z) / 2;
    const std::string expected = z < 0 ? (x < -0.05f  ? "horizontal 0,0"
                                          : x > 0.05f ? "vertical 2,0"
                                                      : "passive")
                                       : (x > 0.05f ? "horizontal 2,1" : "passive");
    EXPECT_EQ(robot.material_names[spring.material], expected);
    named += expected == "passive" ? 0 : 1;
  }
  EXPECT_EQ(named, 3u * 2 * 2);
}

// numpy.savez(file, [[1, 0, 3], [3, 2, 4]], pairs) of NumPy 1.26.4; the same compressed.
TEST(Evogym, BodiesOfNumpyAreWorldsOfOneObject) {
  const Robot from_world = evogym().robots[1];
  for (const auto& file : {stored_body, compressed_body}) {
    const Import import = import_text(base64_decoded(file), "npz", "world");
    ASSERT_EQ(import.robots.size(), 1u);
    EXPECT_EQ(import.robots[0].springs, from_world.springs);
    EXPECT_EQ(import.robots[0].materials, from_world.materials);
    EXPECT_EQ(element_at(import.report, "/arr_0")->outcome, ImportOutcome::mapped);
    EXPECT_EQ(element_at(import.report, "/arr_1")->outcome, ImportOutcome::mapped);
  }
}

TEST(BadEvogym, ArchivesThatAreNone) {
  const std::string file = base64_decoded(stored_body);
  EXPECT_EQ(refusal_of("PK, but no archive", "npz"), "not an archive of NumPy (.npz), or damaged");
  std::string undescribed = file;  // the header of the first array ends with 'descr':
  const std::size_t header = undescribed.find("{'descr'");
  undescribed.replace(undescribed.find('\n', header) - 7, 8, "'descr':");
  undescribed.replace(header, 8, "{'other'");
  EXPECT_EQ(refusal_of(undescribed, "npz"), "not an archive of NumPy (.npz), or damaged");
  for (std::size_t end = 0; end < file.size(); end += 7)
    EXPECT_NE(refusal_of(std::string_view(file).substr(0, end), "npz"), "") << end;
  for (std::size_t place = 0; place < file.size(); ++place) {  // no crash
    std::string damaged = file;
    damaged[place] = static_cast<char>(damaged[place] ^ 0x5a);
    (void)refusal_of(damaged, "npz");
  }
}

TEST(Evogym, TerrainAloneGivesNoRobot) {
  const Import import = import_text(R"({"grid_width": 2, "grid_height": 1, "objects": {
      "ground": {"indices": [0, 1], "types": [5, 5], "neighbors": {}}}})",
                                    "evogym", "flat");
  EXPECT_TRUE(import.robots.empty());
  EXPECT_FALSE(import.report.notes.empty());
}

// The parser took time with the square of the number, minutes here.
TEST(Evogym, ManyObjectsAreReadInTimeInProportion) {
  std::string objects;
  for (int i = 0; i < 200'000; ++i)
    objects += (i == 0 ? "\"o" : ",\"o") + std::to_string(i) + R"(":{"indices":[1],"types":[5],"neighbors":{"1":[]}})";
  const Import import =
      import_text(R"({"grid_width":3,"grid_height":3,"objects":{)" + objects + "}}", "evogym", "world");
  EXPECT_TRUE(import.robots.empty());
}

TEST(BadEvogym, IsRefusedWithItsPlace) {
  const auto refusal = [](const std::string& text) { return refusal_of(text, "evogym"); };
  const auto object = [&](const std::string& data) {
    return refusal(R"({"grid_width": 8, "grid_height": 4, "objects": {"a": )" + data + "}}");
  };
  EXPECT_EQ(refusal("{\"grid_width\": 8"), "line 1, column 16: not valid JSON: unexpected end of input");
  EXPECT_EQ(refusal("{\"grid_width\": 8,\n  objects}"), "line 2, column 3: not valid JSON: invalid literal");
  EXPECT_EQ(refusal("{\"grid_width\": 1e999}"), "a number is too large");
  EXPECT_EQ(refusal("[]"), "/: a world of EvoGym is a JSON object");
  EXPECT_EQ(refusal(R"({"grid_width": -8})"), "/grid_width: give a whole number from 1 to 1000000");
  EXPECT_EQ(refusal(R"({"grid_width": 8, "grid_height": 4})"), "/objects: a world of EvoGym has an object of objects");
  EXPECT_EQ(object("{}"), "/objects/a/indices: is missing; give a list of numbers");
  EXPECT_EQ(object(R"({"indices": [1], "types": [1, 2]})"), "/objects/a/types: has 2 values, indices has 1");
  EXPECT_EQ(object(R"({"indices": [1], "types": [6]})"),
            "/objects/a/types/0: is no type of voxel; give 0 (empty) to 5 (fixed)");
  EXPECT_EQ(object(R"({"indices": [-1], "types": [1]})"), "/objects/a/indices/0: give a whole number of at least 0");
  EXPECT_EQ(object(R"({"indices": [1, 1], "types": [1, 1]})"), "/objects/a/indices/1: the object has this voxel twice");
  EXPECT_EQ(object(R"({"indices": [], "types": []})"), "/objects/a/indices: the object has no voxels");
  EXPECT_EQ(object(R"({"indices": [1, 900000000000], "types": [1, 1]})"),
            "/objects/a: spans 2.25e+11 voxels; at most 4194304 are accepted");
  EXPECT_EQ(refusal(std::string(100, '[')), "nested deeper than 16 levels");
}

}  // namespace
}  // namespace mercury
