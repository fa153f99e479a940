// SPDX-License-Identifier: Apache-2.0
// mercury check: its report, and what it refuses.
#include <gmock/gmock.h>

#include <nlohmann/json.hpp>

#include "tests/app/program.h"

namespace mercury::test {
namespace {

using testing::HasSubstr;
class CheckCommand : public FolderTest {};

const Arguments robots{"--random", "voxel:3", "--seed", "2", "--seconds", "0.5", "--environment", "land"};

// Medians and quartiles are those of `run` with as many trials at each time step.
TEST_F(CheckCommand, ReportsTheMediansOfRunAtEachTimeStep) {
  const Outcome outcome = mercury(joined({"check", "--json"}, robots));
  const auto report = nlohmann::json::parse(outcome.output);
  ASSERT_EQ(report["robots"].size(), 3u);
  EXPECT_EQ(outcome.status, report["confirmed"] == 3 ? 0 : 1);
  for (std::size_t k = 0; k < 3; ++k) {
    const double dt = 1e-3 / (1 << k);
    const auto run = nlohmann::json::parse(
        mercury(joined({"run", "--json", "--trials", "5", "--dt", std::to_string(dt)}, robots)).output);
    for (std::size_t i = 0; i < 3; ++i) {
      const auto& robot = report["robots"][i];
      EXPECT_EQ(robot["name"], run["robots"][i]["name"]);
      EXPECT_EQ(robot["random"], run["robots"][i]["random"]);
      EXPECT_EQ(robot["steps"][k]["dt"], dt);
      EXPECT_EQ(robot["steps"][k]["median"], run["robots"][i]["distance"]);
      EXPECT_EQ(robot["steps"][k]["lower_quartile"], run["robots"][i]["lower_quartile"]);
      EXPECT_EQ(robot["steps"][k]["upper_quartile"], run["robots"][i]["upper_quartile"]);
    }
  }
}

TEST_F(CheckCommand, WritesALinePerRobot) {
  const Outcome outcome = mercury(joined({"check", "--csv", path("a.csv")}, robots));
  EXPECT_THAT(outcome.output, HasSubstr("voxel-2-1"));
  EXPECT_THAT(outcome.output, HasSubstr(" of 3 confirmed\n"));
  const std::string csv = read("a.csv");
  EXPECT_EQ(std::count(csv.begin(), csv.end(), '\n'), 4);
  EXPECT_THAT(csv,
              testing::StartsWith("index,name,file,random,environment,verdict,reason,objective,fate_dt,median_dt,"));
  EXPECT_EQ(mercury(joined({"check", "--csv", "-"}, robots)).output, csv);
}

TEST_F(CheckCommand, NamesAnObjectiveThatIsNotANumber) {
  EXPECT_THAT(mercury(joined({"check", "--csv", path("a.csv"), "--objective", "log(-1)"}, robots)),
              Ends(1, HasSubstr("the objective \"log(-1)\" is not a finite number for 3 of 3 robots")));
  EXPECT_THAT(read("a.csv"),
              HasSubstr("not sound,the objective is not a finite number at dt 0.001 s,log(-1),undefined,"));
}

TEST_F(CheckCommand, RefusesWhatMeansNothing) {
  const auto refusal = [](const Arguments& more) {
    const Outcome outcome = mercury(joined({"check", "--random", "voxel:1"}, more));
    EXPECT_EQ(outcome.status, 2);
    return outcome.messages;
  };
  EXPECT_THAT(refusal({"--environment", "ocean-simple"}), HasSubstr("no robot can move itself in ocean-simple"));
  EXPECT_THAT(refusal({"--objective", "distanse"}), HasSubstr("did you mean distance?"));
  EXPECT_THAT(refusal({"--trials", "0"}), HasSubstr("--trials: 0 is not accepted"));
  EXPECT_THAT(refusal({"--jitter", "0.7"}), HasSubstr("--jitter: 0.7 is not accepted"));
}

// In one call, each robot gets the figures and the verdict that it gets alone.
TEST_F(CheckCommand, TriesEachRobotInItsOwnEnvironment) {
  const Arguments mixed{"sample:paper/strider", "sample:paper/eel", "--random", "voxel:1", "sample:paper/inchworm"},
      short_json{"--json", "--seconds", "0.5", "--trials", "2"};
  const auto report_of = [&](const Arguments& arguments) {
    const Outcome outcome = mercury(joined({"check"}, arguments, short_json));
    EXPECT_EQ(outcome.messages, "");
    return nlohmann::json::parse(outcome.output);
  };
  const auto together = report_of(mixed);
  EXPECT_FALSE(together.contains("configuration"));
  const char* const environments[] = {"land", "ocean", "land", "ocean"};  // in the order of the files, then the random
  ASSERT_EQ(together["robots"].size(), std::size(environments));
  const Arguments alone[] = {
      {"sample:paper/strider"}, {"sample:paper/eel"}, {"sample:paper/inchworm"}, {"--random", "voxel:1"}};
  for (std::size_t i = 0; i < std::size(environments); ++i) {
    auto expected = report_of(alone[i]);
    EXPECT_EQ(together["robots"][i]["environment"], environments[i]);
    EXPECT_EQ(together["configurations"][environments[i]], expected["configuration"]);
    expected["robots"][0]["index"] = i;
    EXPECT_EQ(together["robots"][i], expected["robots"][0]);
  }
  EXPECT_THAT(mercury(joined({"check"}, mixed, {"--seconds", "0.1"})).output,
              AllOf(HasSubstr(", land and ocean, "), HasSubstr("strider    land  "), HasSubstr("eel        ocean ")));
  EXPECT_THAT(mercury(joined({"check"}, mixed, {"--friction", "0.5"})),
              Ends(2, HasSubstr("--friction: ocean has no such parameter")));
}

// A robot that is made for no environment goes where the others live; --environment holds for all.
TEST_F(CheckCommand, PutsAllIntoOneEnvironmentWhereNoneObjects) {
  for (const Arguments& robots_there :
       {Arguments{"sample:paper/strider", "--random", "voxel:1"},
        Arguments{"sample:paper/strider", "sample:paper/eel", "--environment", "land"}}) {
    const auto report = nlohmann::json::parse(
        mercury(joined({"check", "--json", "--seconds", "0.2", "--trials", "1"}, robots_there)).output);
    EXPECT_TRUE(report.contains("configuration"));
    for (const auto& robot : report["robots"]) EXPECT_EQ(robot["environment"], "land");
  }
}

TEST_F(CheckCommand, ADryRunChangesNothing) {
  const Outcome outcome = succeeded(mercury(joined({"check", "--dry-run", "--csv", path("a.csv")}, robots)));
  EXPECT_THAT(outcome.output, HasSubstr("also at dt/2 and dt/4"));
  EXPECT_TRUE(listing("").empty());
}

}  // namespace
}  // namespace mercury::test
