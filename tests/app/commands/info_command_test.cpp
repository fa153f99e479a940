// SPDX-License-Identifier: Apache-2.0
// mercury info: descriptions of files and of the machine.
#include <gmock/gmock.h>

#include "tests/app/program.h"

namespace mercury::test {
namespace {

using testing::HasSubstr;

class InfoCommand : public FolderTest {};

TEST_F(InfoCommand, DescribesAFile) {
  // One voxel has 8 masses, a spring per pair of them (28), and 6 sides of two triangles.
  succeeded(
      mercury({"new", "voxel", "--voxels", "1x1x1", "--air", "0", "--symmetry", "none", "-o", path("cube.json")}));
  const Outcome outcome = succeeded(mercury({"info", path("cube.json")}));
  EXPECT_THAT(outcome.output, testing::ContainsRegex("masses +8\n"));
  EXPECT_THAT(outcome.output, testing::ContainsRegex("springs +28, "));
  EXPECT_THAT(outcome.output, HasSubstr("closed, Euler characteristic 2, 0.06 m2, 0.001 m3"));
  EXPECT_THAT(outcome.output, testing::ContainsRegex("faces +12"));
  EXPECT_THAT(outcome.output, testing::ContainsRegex("size +0.1 x 0.1 x 0.1 m\n"));
  // One tile of 32 masses with 36 bytes each, 256 materials at 8, 64 rest lengths at 4, and 96 for barriers and what
  // threads share.
  EXPECT_THAT(outcome.output, HasSubstr("needs 3.5 kB of a CUDA block's memory in water: fits every CUDA device"));
}

TEST_F(InfoCommand, ListsNamedActuators) {
  write("chain.json", R"({"format":"mercury-robot","version":1,"masses":[[0,0,0],[1,0,0],[2,0,0],[3,0,0]],"faces":[],
    "springs":[[0,1,1],[1,2,2],[2,3,1]],"actuators":[{"name":"ends","materials":[1,3]},{"name":"mid","springs":[1]}]})");
  const Outcome outcome = succeeded(mercury({"info", path("chain.json")}));
  EXPECT_THAT(outcome.output, testing::ContainsRegex("actuators +ends: 2 springs of material 1, 3\n"
                                                     " +mid: 1 spring of material 2\n"));
  succeeded(mercury({"run", path("chain.json"), "--seconds", "0.01", "--record", path("chain.h5")}));
  EXPECT_THAT(mercury({"info", path("chain.h5")}).output,
              HasSubstr("chain: 4 masses, 3 springs, 0 faces, 2 actuators"));
}

TEST_F(InfoCommand, CountsMusclesThatMoveByHalfWaves) {
  write("chain.json", R"({"format":"mercury-robot","version":1,"masses":[[0,0,0],[1,0,0],[2,0,0]],"faces":[],
    "springs":[[0,1,1],[1,2,2]],"materials":[{"stiffness":0},{"stiffness":50,"amplitude":0.1,"half_wave":true},
    {"stiffness":50,"amplitude":0.1}]})");
  EXPECT_THAT(mercury({"info", path("chain.json")}).output, HasSubstr("2 muscles, 1 by half waves"));
  const auto document = nlohmann::json::parse(mercury({"info", "--json", path("chain.json")}).output);
  EXPECT_EQ(document["robots"][0]["materials"][0]["half_wave"], true);
  EXPECT_EQ(document["robots"][0]["materials"][1]["half_wave"], false);
}

// A mass of 2 kg on a spring of 5,000 N/m at a fixed point: w = 50 rad/s, and dt < sqrt(tau^2 + 4 / w^2) - tau.
TEST_F(InfoCommand, SaysTheMassAndTheVibrationsOfABody) {
  write("weight.json", R"({"format":"mercury-robot","version":1,"requires":["mass","fixed"],"faces":[],
    "masses":[[0,0,0.5],[0,0,0]],"mass":[1,2],"fixed":[0],"springs":[[0,1,1]],
    "materials":[{"stiffness":0},{"stiffness":5000,"relaxation_time":0.03}]})");
  const Outcome outcome = succeeded(mercury({"info", path("weight.json")}));
  EXPECT_THAT(outcome.output, testing::ContainsRegex("mass +3 kg, 1 point fixed\n"));
  EXPECT_THAT(outcome.output, testing::ContainsRegex("density +-\n"));
  EXPECT_THAT(outcome.output, testing::ContainsRegex("vibrates +from 7.96 Hz on\n"));
  EXPECT_THAT(outcome.output, testing::ContainsRegex("largest dt +0.02 s with the force solver\n"));
  const auto robot = nlohmann::json::parse(mercury({"info", "--json", path("weight.json")}).output)["robots"][0];
  EXPECT_EQ(robot["mass"], 3.0);
  EXPECT_TRUE(robot["density"].is_null() && robot["modulus"].is_null());
  EXPECT_NEAR(robot["lowest_frequency"], 50 / (2 * 3.14159265358979), 1e-6);
  EXPECT_NEAR(robot["largest_dt"], 0.02, 1e-6);
  EXPECT_EQ(robot["materials"][0]["relaxation_time"], 0.03);
  write("future.json", R"({"format":"mercury-robot","version":1,"requires":["wings"],"masses":[],"springs":[]})");
  EXPECT_THAT(mercury({"info", path("future.json")}),
              Ends(2, HasSubstr("/requires/0: requires \"wings\", which this version does not know")));
}

TEST_F(InfoCommand, WithoutAFileDescribesTheMachine) {
  const Outcome outcome = succeeded(mercury({"info"}));
  for (const char* what : {"processor", "memory", "GPU", "drawing (egl)", "drawing (osmesa)", "encoder"})
    EXPECT_THAT(outcome.output, HasSubstr(what));
  EXPECT_THAT(outcome.output, HasSubstr("writes .mp4 .webm .gif"));
}

TEST_F(InfoCommand, AdvisesOnAMissingEncoder) {
  const Outcome outcome = succeeded(mercury({"info", "--ffmpeg", path("none")}));
  EXPECT_THAT(outcome.output, HasSubstr(path("none") + " does not run"));
  EXPECT_THAT(outcome.output, HasSubstr("apt install ffmpeg"));
}

nlohmann::json info_json(const Arguments& arguments) {
  const Outcome outcome = succeeded(mercury(joined({"info", "--json"}, arguments)));
  return nlohmann::json::parse(outcome.output, nullptr, false);
}

std::vector<std::string> names_of(const nlohmann::json& list, const char* name = "name") {
  std::vector<std::string> names;
  for (const auto& entry : list) names.push_back(entry[name].get<std::string>());
  return names;
}

TEST_F(InfoCommand, JsonHoldsWhatThePathsName) {
  succeeded(mercury(
      {"new", "voxel", "--voxels", "1x1x1", "--air", "0", "--symmetry", "none", "-o", path("r/"), "--count", "2"}));
  write("chain.json", R"({"format":"mercury-robot","version":1,"masses":[[0,0,0],[1,0,0],[2,0,0],[3,0,0]],"faces":[],
    "springs":[[0,1,1],[1,2,2],[2,3,1]],"actuators":[{"name":"ends","materials":[1,3]},{"name":"mid","springs":[1]}]})");
  succeeded(mercury({"run", path("chain.json"), "--seconds", "0.01", "--every", "2", "--record", path("a.h5")}));
  const auto json = info_json({path("chain.json"), path("r"), path("a.h5")});
  EXPECT_TRUE(json["machine"].is_null());
  EXPECT_EQ(names_of(json["robots"]), (std::vector<std::string>{"chain", "voxel-1-0", "voxel-1-1"}));
  EXPECT_EQ(json["robots"][0]["file"], path("chain.json"));
  EXPECT_EQ(json["robots"][0]["actuators"],
            nlohmann::json::parse(R"([{"name": "ends", "materials": [1, 3], "springs": 2},
                                      {"name": "mid", "materials": [2], "springs": 1}])"));
  // A cube: 8 masses, a spring per pair of them, 6 sides of two triangles.
  const auto& cube = json["robots"][1];
  EXPECT_EQ(cube["masses"], 8);
  EXPECT_EQ(cube["springs"], 28);
  EXPECT_EQ(cube["faces"], 12);
  EXPECT_EQ(cube["springs_per_mass"], 7.0);
  EXPECT_EQ(cube["closed"], true);
  EXPECT_EQ(cube["euler_characteristic"], 2);
  EXPECT_NEAR(cube["volume"], 0.001, 1e-8);
  EXPECT_NEAR(cube["length"], 0.1, 1e-7);
  EXPECT_EQ(cube["kind"], "voxel");
  EXPECT_EQ(json["recordings"].size(), 1u);
  const auto& recording = json["recordings"][0];
  EXPECT_EQ(recording["frames"], 6);
  EXPECT_EQ(recording["every"], 2);
  EXPECT_EQ(recording["last_time"], 0.01);
  EXPECT_EQ(recording["configuration"]["dt"], 0.001);
  EXPECT_EQ(names_of(recording["robots"]), std::vector<std::string>{"chain"});
  EXPECT_TRUE(json["repros"].empty() && json["runs"].empty());
}

TEST_F(InfoCommand, JsonOfTheMachineAndOfARun) {
  const auto machine = info_json({});
  const auto whats = names_of(machine["machine"], "what");
  for (const char* what : {"processor", "memory", "GPU", "encoder"}) EXPECT_THAT(whats, testing::Contains(what));
  EXPECT_TRUE(machine["robots"].empty());
  succeeded(mercury({"evolve", path("run"), "--from", "voxel:2x2x2", "--population", "6", "--generations", "2",
                     "--seconds", "0.05", "--strain-limit", "1.5", "--quiet"}));
  const auto run = info_json({path("run")})["runs"][0];
  EXPECT_EQ(run["generations"], 2);
  EXPECT_EQ(run["last_generation"], 2);
  EXPECT_EQ(run["born"], 18);
  EXPECT_EQ(run["living"], 6);
  EXPECT_EQ(run["trials"]["strain_limit"], 1.5);
  EXPECT_EQ(run["algorithm"]["population"], 6);
  int sum = 0;
  for (const auto& [fate, number] : run["fates"].items()) sum += number.get<int>();
  EXPECT_EQ(sum, 18);
  EXPECT_EQ(run["best"]["scores"][0], run["best"]["quantities"]["distance"]);
  EXPECT_EQ(run["best"]["line"].back(), run["best"]["id"]);
  EXPECT_TRUE(run["files"].contains("genomes"));
}

TEST_F(InfoCommand, BadFileIsBadInput) {
  write("a.json", "{}");
  EXPECT_THAT(mercury({"info", path("a.json")}), Ends(2, testing::StartsWith(path("a.json") + ": ")));
}

}  // namespace
}  // namespace mercury::test
