// SPDX-License-Identifier: Apache-2.0
// mercury run: its reports, and results that do not depend on threads or on other robots.
#include <fmt/format.h>
#include <gmock/gmock.h>

#include <cmath>
#include <map>

#include "app/recording/trajectory_reader.h"
#include "tests/app/program.h"

namespace mercury::test {
namespace {

using nlohmann::json;
using testing::HasSubstr;

json run_json(std::vector<std::string> arguments) {
  const Outcome outcome = succeeded(mercury(joined({"run"}, arguments, {"--json"})));
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
    EXPECT_GE(robot["mean_speed"].get<double>() * 0.5, robot["distance"].get<double>() * (1 - 1e-6));
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

TEST_F(RunCommand, FoldingIsMeasuredWhereItIsAskedFor) {
  const std::vector<std::string> plain{"--random", "voxel:2", "--seconds", "0.2"};
  const json without = run_json(plain);
  for (const Arguments& asks : {std::vector<std::string>{"--folding"}, {"--overlap-limit", "0.5"}}) {
    const json with = run_json(joined(plain, asks));
    for (std::size_t i = 0; i < 2; ++i) {
      EXPECT_TRUE(without["robots"][i]["inverted"].is_null());
      EXPECT_EQ(with["robots"][i]["inverted"], 0.0);
      EXPECT_EQ(with["robots"][i]["overlap"], 0.0);
      EXPECT_EQ(with["robots"][i]["hash"], without["robots"][i]["hash"]);
    }
  }
}

TEST_F(RunCommand, UprightIsMeasuredWhereItIsAskedFor) {
  const std::vector<std::string> plain{"--random", "voxel:2", "--seconds", "0.2"};
  const json without = run_json(plain);
  const json with = run_json(joined(plain, {"--upright"}));
  for (std::size_t i = 0; i < 2; ++i) {
    EXPECT_TRUE(without["robots"][i]["upright"].is_null());
    EXPECT_GT(with["robots"][i]["upright"], 0.9) << "in water, without time to turn";
    EXPECT_LT(with["robots"][i]["upright"], 1.000001);
    EXPECT_EQ(with["robots"][i]["hash"], without["robots"][i]["hash"]);
  }
}

// The usual limits ask for it, and others need not.
TEST_F(RunCommand, FoldingOfRealBodiesIsMeasured) {
  const std::vector<std::string> real{"--random", "voxel:2", "--physics", "real", "--seconds", "0.2"};
  const json with = run_json(real), without = run_json(joined(real, {"--inverted-limit", "1"}));
  for (std::size_t i = 0; i < 2; ++i) {
    EXPECT_EQ(with["robots"][i]["inverted"], 0.0);
    EXPECT_TRUE(without["robots"][i]["inverted"].is_null());
  }
}

TEST_F(RunCommand, ResultsNameThePhysics) {
  for (const std::string physics : {"paper", "real"}) {
    const json report = run_json({"--random", "voxel:1", "--seconds", "0.01", "--physics", physics});
    EXPECT_EQ(report["robots"][0]["physics"], physics);
    EXPECT_THAT(mercury({"run", "--random", "voxel:1", "--seconds", "0.01", "--physics", physics}).output,
                HasSubstr(", " + physics + " physics, "));
  }
}

TEST_F(RunCommand, ATimeStepThatIsTooLongIsNamed) {
  const Arguments run{"run", "--random", "voxel:1", "--physics", "real", "--seconds", "0.1"};
  EXPECT_THAT(mercury(run).messages, testing::Not(HasSubstr("too fast")));
  EXPECT_THAT(mercury(joined(run, {"--dt", "0.02"})).messages,
              testing::ContainsRegex("vibrates too fast for this time step, 0.02 s: the force solver is stable up to "
                                     "0.00[0-9]+ s; give a shorter one, or --substeps [0-9]+"));
}

TEST_F(RunCommand, HashesAreReproducibleWithAnyNumberOfThreads) {
  const Arguments arguments{"--random", "voxel:16", "--seed", "1", "--seconds", "0.3", "--device", "cpu"};
  const Arguments one_thread = joined(arguments, {"--threads", "1"});
  const auto first = hashes(run_json(arguments));
  EXPECT_EQ(first.size(), 16u);
  EXPECT_EQ(hashes(run_json(arguments)), first);
  EXPECT_EQ(hashes(run_json(one_thread)), first);
}

TEST_F(RunCommand, RobotAloneEndsAsInTheGroup) {
  succeeded(mercury({"new", "voxel", "-o", folder_.string(), "--count", "4", "--seed", "1"}));
  const auto group = hashes(run_json({"--random", "voxel:4", "--seed", "1", "--seconds", "0.3"}));
  EXPECT_EQ(hashes(run_json({folder_.string(), "--seconds", "0.3"})), group);
  for (const auto& [name, hash] : group) {
    const auto alone = hashes(run_json({path(name + ".json"), "--seconds", "0.3"}));
    EXPECT_EQ(alone, (std::map<std::string, std::string>{{name, hash}}));
  }
}

// A recording needs all robots in one simulation, and other runs do not.
TEST_F(RunCommand, ARecordingChangesNoResult) {
  const Arguments robots{"--random", "voxel:5", "--seconds", "0.25", "--environment", "land"};
  EXPECT_EQ(run_json(joined(robots, {"--record", path("a.h5")}))["robots"], run_json(robots)["robots"]);
}

TEST_F(RunCommand, DifferentRunsHaveDifferentHashes) {
  const auto shorter = hashes(run_json({"--random", "voxel:1", "--seconds", "0.3"}));
  const auto longer = hashes(run_json({"--random", "voxel:1", "--seconds", "0.301"}));
  EXPECT_NE(shorter, longer);
}

// A body falls from rest through vacuum (density 0) for 0.5 s. Without drag and damping, its center of mass follows
// x = g t^2 / 2.
TEST_F(RunCommand, DistanceIsThatOfAFallingBody) {
  const json report = run_json({"--random", "voxel:1", "--seconds", "0.5", "--density", "0", "--damping", "0",
                                "--gravity", "2", "--dt", "0.0005"});
  const json& robot = report["robots"][0];
  EXPECT_NEAR(robot["distance"], 0.5 * 2 * 0.25, 0.001);
  EXPECT_NEAR(robot["start_z"].get<double>() - robot["end_z"].get<double>(), 0.5 * 2 * 0.25, 0.001);
  EXPECT_NEAR(robot["mean_speed"], 0.5, 0.002);
}

// Before muscles act, a body on land that rests on nothing falls like a stone: by g t^2 / 2. Along the ground it gets
// nowhere.
TEST_F(RunCommand, AFallOnLandIsNoDistance) {
  write("drop.json", R"({"format": "mercury-robot", "version": 1, "name": "drop", "faces": [],
    "masses": [[0,0,0],[0,0,9],[0.1,0,9],[0,0.1,9],[0,0,9.1]],
    "springs": [[1,2,21],[1,3,21],[1,4,21],[2,3,21],[2,4,21],[3,4,21]]})");
  // Four of five masses are in the air. The one on the ground stays there.
  const json robot = run_json(
      {path("drop.json"), "--environment", "land", "--damping", "0", "--dt", "0.0005", "--seconds", "1"})["robots"][0];
  const double fall = 0.8 * 0.5 * 9.81;
  EXPECT_NEAR(robot["start_z"].get<double>() - robot["end_z"].get<double>(), fall, 0.01);
  EXPECT_NEAR(robot["distance"], 0, 1e-4);
  EXPECT_NEAR(robot["mean_speed"], fall, 0.01);  // its path has that length
  EXPECT_NEAR(robot["highest"], robot["start_z"], 1e-6);
}

TEST_F(RunCommand, NothingIsMeasuredWhileRobotsSettle) {
  const Arguments run{"--random", "voxel:3", "--environment", "land", "--dt", "0.002"};
  const auto with = [&](const Arguments& more) { return run_json(joined(run, more)); };
  const json whole = with({"--seconds", "1"}), settling = with({"--seconds", "0.5"}),
             rest = with({"--seconds", "1", "--settle", "0.5"});
  EXPECT_EQ(rest["settle"], 0.5);
  EXPECT_EQ(rest["steps"], 500);
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_EQ(rest["robots"][i]["hash"], whole["robots"][i]["hash"]);
    const auto at = [&](const json& report, const char* name) { return report["robots"][i][name].get<double>(); };
    for (const char axis : {'x', 'y', 'z'})
      EXPECT_EQ(at(rest, fmt::format("start_{}", axis).c_str()), at(settling, fmt::format("end_{}", axis).c_str()));
    EXPECT_NEAR(at(rest, "distance"),
                std::hypot(at(whole, "end_x") - at(settling, "end_x"), at(whole, "end_y") - at(settling, "end_y")),
                1e-6);
    for (const char* work : {"work", "positive_work", "absolute_work"})
      EXPECT_NEAR(at(rest, work), at(whole, work) - at(settling, work), 1e-6);  // sums of the same samples
    EXPECT_NEAR(at(rest, "absolute_work"), 2 * at(rest, "positive_work") - at(rest, "work"), 1e-9);
    EXPECT_GE(at(rest, "positive_work"), at(rest, "work"));
  }
}

TEST_F(RunCommand, SettlingTakesAPartOfTheTime) {
  for (const auto& [settle, said] : {std::pair{"-1", "-1"}, {"nan", "nan"}, {"2", "2"}, {"1", "1"}, {"inf", "inf"}}) {
    const Outcome outcome = mercury({"run", "--random", "voxel:1", "--seconds", "1", "--settle", settle});
    EXPECT_EQ(outcome.status, 2);
    EXPECT_EQ(outcome.messages,
              fmt::format("mercury: --settle: {} is not accepted; give 0 s or more, and less than the "
                          "1 s of --seconds\n",
                          said));
  }
}

// Names need not be unique; the index and the file, or the request, are.
TEST_F(RunCommand, ResultsNameTheFileAndTheRequestOfEachRobot) {
  std::filesystem::create_directory(path("a"));
  for (const char* file : {"a/one.json", "two.json"})
    write(file, R"({"format": "mercury-robot", "version": 1, "name": "twin", "masses": [[0,0,0],[1,0,0]],
                    "springs": [[0,1,21]], "faces": []})");
  const Arguments arguments{path("a"), path("two.json"), "--random", "voxel:2:7:40", "--seconds", "0.01"};
  const json robots = run_json(arguments)["robots"];
  ASSERT_EQ(robots.size(), 4u);
  const json files{path("a/one.json"), path("two.json"), nullptr, nullptr},
      random{nullptr, nullptr, "voxel:1:7:40", "voxel:1:7:41"}, names{"twin", "twin", "voxel-7-40", "voxel-7-41"};
  for (std::size_t i = 0; i < 4; ++i) {
    EXPECT_EQ(robots[i]["index"], i);
    EXPECT_EQ(robots[i]["name"], names[i]);
    EXPECT_EQ(robots[i]["file"], files[i]);
    EXPECT_EQ(robots[i]["random"], random[i]);
  }
  // Each alone is the same robot.
  EXPECT_EQ(run_json({"--random", "voxel:1:7:41", "--seconds", "0.01"})["robots"][0]["hash"], robots[3]["hash"]);
  EXPECT_THAT(mercury(joined({"run"}, arguments)).output,
              testing::AllOf(HasSubstr("/a/one.json)"), HasSubstr("/two.json)")));
}

TEST_F(RunCommand, TableShowsEachRobot) {
  const Outcome outcome = succeeded(mercury({"run", "--random", "voxel:2", "--seed", "9", "--seconds", "0.1"}));
  EXPECT_THAT(outcome.output, HasSubstr("voxel-9-0"));
  EXPECT_THAT(outcome.output, HasSubstr("voxel-9-1"));
  EXPECT_THAT(outcome.output, HasSubstr("distance [m]"));
  EXPECT_THAT(outcome.output, HasSubstr("strain [%]  > 50 [%]"));
  EXPECT_EQ(outcome.messages, "");
}

TEST_F(RunCommand, CsvHasALinePerRobot) {
  const Arguments robots{"--random", "voxel:2", "--seconds", "0.1"};
  succeeded(mercury({"run", "--random", "voxel:2", "--seconds", "0.1", "--csv", path("a.csv")}));
  const json report = run_json(robots);
  std::istringstream csv(read("a.csv"));
  // A column for each member of the objects, with the same values.
  const auto fields_of = [&] {
    std::string line, field;
    std::getline(csv, line);
    std::vector<std::string> fields;
    for (std::istringstream rest(line + ","); std::getline(rest, field, ',');) fields.push_back(field);
    return fields;
  };
  const std::vector<std::string> columns = fields_of();
  for (const json& robot : report["robots"]) {
    const std::vector<std::string> fields = fields_of();
    ASSERT_EQ(fields.size(), columns.size());
    EXPECT_EQ(robot.size(), columns.size());
    for (std::size_t i = 0; i < columns.size(); ++i) {
      const json& value = robot.at(columns[i]);
      if (value.is_number_float())
        EXPECT_EQ(std::stod(fields[i]), value.get<double>()) << columns[i];
      else
        EXPECT_EQ(fields[i], value.is_null() ? "" : value.is_string() ? value.get<std::string>() : value.dump());
    }
  }
  EXPECT_EQ(listing(), std::vector<std::string>{"a.csv"});
}

TEST_F(RunCommand, CsvThatCannotBeWrittenIsBadInput) {
  write("no", "");
  EXPECT_THAT(mercury({"run", "--random", "voxel", "--seconds", "0.01", "--csv", path("no/a.csv")}),
              Ends(2, "--csv: " + path("no/a.csv") + " cannot be written: " + path("no") + " is no folder"));
}

TEST_F(RunCommand, CsvGoesToAFolderNever) {
  EXPECT_THAT(mercury({"run", "--random", "voxel", "--seconds", "0.01", "--csv", path("")}),
              Ends(2, "--csv: " + path("") + " is a folder; give a file"));
}

TEST_F(RunCommand, CsvOnStandardOutputReplacesTheTable) {
  const Arguments run{"run", "--random", "voxel:2", "--seconds", "0.1", "--csv"};
  const auto with = [&](const std::string& file) { return mercury(joined(run, {file})); };
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
    return run_json(joined(arguments, {"--seconds", "0.01"}))["configuration"]["environment"].get<std::string>();
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
  const Outcome outcome = succeeded(mercury(unstable));
  EXPECT_THAT(outcome.messages, HasSubstr("1 of 1 robots exploded"));
  const json robot = json::parse(outcome.output, nullptr, false)["robots"][0];
  EXPECT_EQ(robot["exploded"], true);
  EXPECT_GT(robot["exploded_at"], 0.0);
  EXPECT_EQ(robot["first_bad_spring"], 0);
  EXPECT_EQ(robot["fate"], "exploded");
  EXPECT_EQ(robot["start_x"], 0.5);
  // What depends on how far it got means nothing.
  for (const char* figure : {"distance", "end_x", "end_y", "end_z", "mean_speed", "work", "positive_work",
                             "absolute_work", "highest", "largest_strain", "strained_share"})
    EXPECT_TRUE(robot[figure].is_null()) << figure;

  const Arguments strict = joined(unstable, {"--strict"});
  EXPECT_EQ(mercury(strict).status, 1);
  EXPECT_EQ(mercury({"run", path("pair.json"), "--dt", "0.01", "--seconds", "2", "--strict"}).status, 0);
}

// Robots of a limit below the strain that they have all are overstretched, and their figures stay.
TEST_F(RunCommand, StrainLimitMarksRobots) {
  const Arguments run{"--random", "voxel:2", "--seconds", "0.5"};
  const json sound = run_json(run)["robots"], marked = run_json(joined(run, {"--strain-limit", "1e-6"}))["robots"];
  for (std::size_t i = 0; i < 2; ++i) {
    EXPECT_EQ(sound[i]["fate"], "sound");
    EXPECT_EQ(marked[i]["fate"], "overstretched");
    EXPECT_EQ(marked[i]["distance"], sound[i]["distance"]);
  }
}

TEST_F(RunCommand, CsvAndJsonDoNotShareStandardOutput) {
  const Outcome outcome = mercury({"run", "--random", "voxel", "--seconds", "0.01", "--json", "--csv", "-"});
  EXPECT_EQ(outcome.status, 2);
  EXPECT_THAT(outcome.messages, HasSubstr("--csv: - and --json both mean standard output; give --csv a file"));
}

TEST_F(RunCommand, ABrokenStandardOutputLosesNoRecording) {
  for (const char* output : {">/dev/full", ">&-"}) {
    const std::string command = std::string(MERCURY_PROGRAM) +
                                " run --random voxel:2 --seconds 0.1 --every 10 --force" + " --record " + path("a.h5") +
                                " " + output;
    EXPECT_THAT(run_program("sh", {"-c", command}), Ends(1, HasSubstr("standard output cannot be written"))) << output;
    EXPECT_EQ(TrajectoryReader(path("a.h5")).frames(), 11u) << output;
    std::filesystem::remove(path("a.h5"));
  }
}

// The results are worth more than where they go.
TEST_F(RunCommand, ABrokenStandardOutputLosesNoCsv) {
  const std::string command =
      std::string(MERCURY_PROGRAM) + " run --random voxel:2 --seconds 0.01 --csv " + path("a.csv") + " > /dev/full";
  EXPECT_THAT(run_program("sh", {"-c", command}), Ends(1, HasSubstr("standard output cannot be written")));
  const std::string csv = read("a.csv");
  EXPECT_EQ(std::count(csv.begin(), csv.end(), '\n'), 3);
}

// 2,000 rows are more than a pipe holds.
TEST_F(RunCommand, AReaderWhoLeavesLosesNoCsv) {
  const std::string command = std::string(MERCURY_PROGRAM) +
                              " run --random voxel:2000 --voxels 1x1x1 --seconds 0.001 -q --csv " + path("a.csv") +
                              " | exit 0";
  run_program("sh", {"-c", command});
  const std::string csv = read("a.csv");
  EXPECT_EQ(std::count(csv.begin(), csv.end(), '\n'), 2001);
}

TEST_F(RunCommand, ACsvThatFailsLosesNoTable) {
  for (const bool as_json : {false, true}) {
    std::vector<std::string> arguments{"run", "--random", "voxel:2", "--seconds", "0.01", "--csv", "/dev/full"};
    if (as_json) arguments.push_back("--json");
    const Outcome outcome = mercury(arguments);
    EXPECT_NE(outcome.status, 0);
    EXPECT_THAT(outcome.messages, HasSubstr("/dev/full"));
    EXPECT_THAT(outcome.output, HasSubstr("voxel-1-1"));
  }
}

TEST_F(RunCommand, InterruptedRunReportsItsResults) {
  const auto child = working_mercury({"run", "--random", "voxel:2", "--seconds", "1e6", "--json"});
  child->signal(SIGINT);
  const Outcome outcome = outcome_of(*child);
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
    EXPECT_THAT(mercury({"run", path(name)}), Ends(2, testing::StartsWith(path(name) + ": ")));
  }
}

}  // namespace
}  // namespace mercury::test
