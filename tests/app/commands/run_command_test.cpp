// SPDX-License-Identifier: Apache-2.0
// mercury run: its reports, and results that do not depend on threads or on other robots.
#include <gmock/gmock.h>

#include <map>

#include "tests/app/program.h"

namespace mercury::test {
namespace {

using nlohmann::json;
using testing::HasSubstr;

json run_json(std::vector<std::string> arguments) {
  arguments.insert(arguments.begin(), "run");
  arguments.push_back("--json");
  const Outcome outcome = mercury(arguments);
  EXPECT_EQ(outcome.status, 0) << outcome.messages;
  return json::parse(outcome.output, nullptr, false);
}

std::map<std::string, std::string> hashes(const json& report) {
  std::map<std::string, std::string> found;
  for (const json& robot : report["robots"]) found[robot["name"]] = robot["hash"];
  return found;
}

class RunCommand : public FolderTest {};

TEST_F(RunCommand, JsonHoldsConfigurationAndEachRobot) {
  const json report = run_json({"--random", "voxel:3", "--seed", "5", "--seconds", "0.5", "--dt", "0.002"});
  EXPECT_EQ(report["configuration"]["dt"], 0.002);
  EXPECT_EQ(report["configuration"]["environment"], "ocean");
  EXPECT_EQ(report["configuration"]["density"], 1000.0);
  EXPECT_EQ(report["steps"], 250);
  EXPECT_DOUBLE_EQ(report["seconds"], 0.5);
  EXPECT_GT(report["wall_seconds"], 0.0);
  EXPECT_GT(report["springs_per_second"], 0.0);
  ASSERT_EQ(report["robots"].size(), 3u);
  for (const json& robot : report["robots"]) {
    EXPECT_GT(robot["masses"], 0);
    EXPECT_GT(robot["springs"], 0);
    // Muscles act from the first step on. A path is at least as long as the distance between its ends.
    EXPECT_GT(robot["largest_strain"], 0.0);
    EXPECT_GE(robot["mean_speed"].get<double>() * 0.5, robot["displacement"].get<double>() * (1 - 1e-6));
    EXPECT_EQ(robot["exploded"], false);
    EXPECT_EQ(robot["hash"].get<std::string>().size(), 16u);
  }
}

// A sample has springs above 50 % strain if its largest strain is above that. Bodies of soft springs
// collapse on land. In 0.02 s, 26 muscles that pull a mass by 50 N/m * 14 mm each move it by 4 mm, of 0.1 m.
TEST_F(RunCommand, ShareOfStrainedSpringsGoesWithTheLargestStrain) {
  for (const bool collapses : {false, true}) {
    std::vector<std::string> arguments{"--random", "voxel:3", "--seconds", collapses ? "0.5" : "0.02"};
    if (collapses) arguments.insert(arguments.end(), {"--environment", "land", "--stiffness-scale", "2"});
    const json report = run_json(arguments);
    ASSERT_EQ(report["robots"].size(), 3u);
    for (const json& robot : report["robots"]) {
      const auto share = robot["strained_share"].get<double>();
      EXPECT_EQ(share > 0, collapses);
      EXPECT_EQ(share > 0, robot["largest_strain"].get<double>() > 0.5);
      EXPECT_LT(share, 1);
    }
  }
}

TEST_F(RunCommand, HashesAreReproducibleWithAnyNumberOfThreads) {
  const std::vector<std::string> arguments{"--random",  "voxel:16", "--seed",   "1",
                                           "--seconds", "0.3",      "--device", "cpu"};
  std::vector<std::string> one_thread = arguments;
  one_thread.insert(one_thread.end(), {"--threads", "1"});
  const auto first = hashes(run_json(arguments));
  EXPECT_EQ(first.size(), 16u);
  EXPECT_EQ(hashes(run_json(arguments)), first);
  EXPECT_EQ(hashes(run_json(one_thread)), first);
}

TEST_F(RunCommand, RobotAloneEndsAsInTheGroup) {
  ASSERT_EQ(mercury({"new", "voxel", "-o", folder_.string(), "--count", "4", "--seed", "1"}).status, 0);
  const auto group = hashes(run_json({"--random", "voxel:4", "--seed", "1", "--seconds", "0.3"}));
  EXPECT_EQ(hashes(run_json({folder_.string(), "--seconds", "0.3"})), group);
  for (const auto& [name, hash] : group) {
    const auto alone = hashes(run_json({path(name + ".json"), "--seconds", "0.3"}));
    EXPECT_EQ(alone, (std::map<std::string, std::string>{{name, hash}}));
  }
}

// A recording needs all robots in one simulation, and other runs do not.
TEST_F(RunCommand, ARecordingChangesNoResult) {
  const std::vector<std::string> robots{"--random", "voxel:5", "--seconds", "0.25", "--environment", "land"};
  std::vector<std::string> recorded = robots;
  recorded.insert(recorded.end(), {"--record", path("a.h5")});
  EXPECT_EQ(run_json(recorded)["robots"], run_json(robots)["robots"]);
}

TEST_F(RunCommand, DifferentRunsHaveDifferentHashes) {
  const auto shorter = hashes(run_json({"--random", "voxel:1", "--seconds", "0.3"}));
  const auto longer = hashes(run_json({"--random", "voxel:1", "--seconds", "0.301"}));
  EXPECT_NE(shorter, longer);
}

// A body falls from rest through vacuum (density 0) for 0.5 s. Without drag and damping, its centre of mass follows
// x = g t^2 / 2.
TEST_F(RunCommand, DisplacementIsThatOfAFallingBody) {
  const json report = run_json({"--random", "voxel:1", "--seconds", "0.5", "--density", "0", "--damping", "0",
                                "--gravity", "2", "--dt", "0.0005"});
  EXPECT_NEAR(report["robots"][0]["displacement"], 0.5 * 2 * 0.25, 0.001);
  EXPECT_NEAR(report["robots"][0]["mean_speed"], 0.5, 0.002);
}

TEST_F(RunCommand, TableShowsEachRobot) {
  const Outcome outcome = mercury({"run", "--random", "voxel:2", "--seed", "9", "--seconds", "0.1"});
  EXPECT_EQ(outcome.status, 0);
  EXPECT_THAT(outcome.output, HasSubstr("voxel-9-0"));
  EXPECT_THAT(outcome.output, HasSubstr("voxel-9-1"));
  EXPECT_THAT(outcome.output, HasSubstr("moved [m]"));
  EXPECT_THAT(outcome.output, HasSubstr("strain [%]  > 50 [%]"));
  EXPECT_EQ(outcome.messages, "");
}

TEST_F(RunCommand, CsvHasALinePerRobot) {
  const std::vector<std::string> robots{"--random", "voxel:2", "--seconds", "0.1"};
  const Outcome outcome = mercury({"run", "--random", "voxel:2", "--seconds", "0.1", "--csv", path("a.csv")});
  ASSERT_EQ(outcome.status, 0);
  const json report = run_json(robots);
  std::istringstream csv(read("a.csv"));
  std::string header, line;
  std::getline(csv, header);
  const char* const columns =
      "name,masses,springs,displacement,mean_speed,largest_strain,strained_share,exploded,exploded_at,"
      "first_bad_spring,hash";  // columns
  EXPECT_EQ(header, columns);
  for (const json& robot : report["robots"]) {
    std::getline(csv, line);
    EXPECT_EQ(line.substr(0, line.find(',')), robot["name"].get<std::string>());
    EXPECT_EQ(line.substr(line.rfind(',') + 1), robot["hash"].get<std::string>());
  }
  EXPECT_EQ(listing(), std::vector<std::string>{"a.csv"});
}

TEST_F(RunCommand, CsvThatCannotBeWrittenIsBadInput) {
  write("no", "");
  const Outcome outcome = mercury({"run", "--random", "voxel", "--seconds", "0.01", "--csv", path("no/a.csv")});
  EXPECT_EQ(outcome.status, 2);
  EXPECT_EQ(outcome.messages,
            "mercury: --csv: " + path("no/a.csv") + " cannot be written: " + path("no") + " is no folder\n");
}

TEST_F(RunCommand, CsvGoesToAFolderNever) {
  const Outcome outcome = mercury({"run", "--random", "voxel", "--seconds", "0.01", "--csv", path("")});
  EXPECT_EQ(outcome.status, 2);
  EXPECT_EQ(outcome.output, "");
  EXPECT_EQ(outcome.messages, "mercury: --csv: " + path("") + " is a folder; give a file\n");
}

TEST_F(RunCommand, CsvOnStandardOutputReplacesTheTable) {
  const std::vector<std::string> run{"run", "--random", "voxel:2", "--seconds", "0.1", "--csv"};
  const auto with = [&](const std::string& file) {
    std::vector<std::string> arguments = run;
    arguments.push_back(file);
    return mercury(arguments);
  };
  ASSERT_EQ(with(path("a.csv")).status, 0);
  EXPECT_EQ(with("-").output, read("a.csv"));
  EXPECT_EQ(with("/dev/stdout").output, read("a.csv"));
  EXPECT_EQ(listing(), std::vector<std::string>{"a.csv"});
}

// A robot file can name its environment.
TEST_F(RunCommand, RobotsUseTheEnvironmentOfTheirFile) {
  const auto robot = [](const std::string& environment) {
    return R"({"format": "mercury-robot", "version": 1, "masses": [[0,0,0],[1,0,0]], "springs": [[0,1,21]], "faces": [],
               "origin": {"kind": "voxel", "environment": ")" +
           environment + "\"}}";
  };
  write("crawler.json", robot("land"));
  write("fish.json", robot("ocean"));
  const auto environment = [&](std::vector<std::string> arguments) {
    arguments.insert(arguments.end(), {"--seconds", "0.01"});
    return run_json(arguments)["configuration"]["environment"].get<std::string>();
  };
  EXPECT_EQ(environment({path("crawler.json")}), "land");
  EXPECT_EQ(environment({path("fish.json")}), "ocean");
  EXPECT_EQ(environment({path("crawler.json"), "--environment", "ocean-simple"}), "ocean-simple");
  EXPECT_EQ(environment({path("crawler.json"), path("fish.json")}), "ocean");
  const Outcome both = mercury({"run", path("crawler.json"), path("fish.json"), "--seconds", "0.01"});
  EXPECT_EQ(both.messages,
            "mercury: the robots are made for land and ocean; all are put into ocean, --environment chooses\n");
}

TEST_F(RunCommand, ExplodedRobotsAreReportedAndFailOnlyWithStrict) {
  // Two masses on a spring of 50 N/m: omega = sqrt(2 k / m) = 10 rad/s, unstable for dt > 2 / omega = 0.2 s.
  write("pair.json",
        R"({"format": "mercury-robot", "version": 1, "name": "pair", "masses": [[0,0,0],[1,0,0]],
            "springs": [[0,1,1,1]], "faces": []})");
  const std::vector<std::string> unstable{"run", path("pair.json"), "--dt", "1", "--seconds", "200", "--json"};
  const Outcome outcome = mercury(unstable);
  EXPECT_EQ(outcome.status, 0);
  EXPECT_THAT(outcome.messages, HasSubstr("1 of 1 robots exploded"));
  const json robot = json::parse(outcome.output, nullptr, false)["robots"][0];
  EXPECT_EQ(robot["exploded"], true);
  EXPECT_GT(robot["exploded_at"], 0.0);
  EXPECT_EQ(robot["first_bad_spring"], 0);

  std::vector<std::string> strict = unstable;
  strict.push_back("--strict");
  EXPECT_EQ(mercury(strict).status, 1);
  EXPECT_EQ(mercury({"run", path("pair.json"), "--dt", "0.01", "--seconds", "2", "--strict"}).status, 0);
}

TEST_F(RunCommand, InterruptedRunReportsItsResults) {
  ChildProcess child(MERCURY_PROGRAM, {"run", "--random", "voxel:2", "--seconds", "1e6", "--json"});
  // The first line of progress shows that the simulation runs.
  while (child.messages().empty()) std::this_thread::yield();
  child.signal(SIGINT);
  const Outcome outcome = outcome_of(child);
  EXPECT_EQ(outcome.status, 128 + SIGINT);
  const json report = json::parse(outcome.output, nullptr, false);
  EXPECT_EQ(report["interrupted"], true);
  EXPECT_EQ(report["robots"].size(), 2u);
  EXPECT_THAT(outcome.messages, HasSubstr("stopped at"));
}

TEST_F(RunCommand, InvalidRobotFilesAreReportedInOneLine) {
  write("text.json", "not a robot");
  write("number.json", R"({"format": "mercury-robot", "version": 1, "masses": [[0,0,0]], "springs": [[0,5,1]]})");
  for (const char* name : {"text.json", "number.json"}) {
    const Outcome outcome = mercury({"run", path(name)});
    EXPECT_EQ(outcome.status, 2);
    EXPECT_THAT(outcome.messages, testing::StartsWith("mercury: " + path(name) + ": "));
    EXPECT_EQ(std::count(outcome.messages.begin(), outcome.messages.end(), '\n'), 1);
  }
}

}  // namespace
}  // namespace mercury::test
