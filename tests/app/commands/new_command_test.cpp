// SPDX-License-Identifier: Apache-2.0
// mercury new: robot files.
#include <gmock/gmock.h>

#include <algorithm>
#include <map>

#include "mercury/origin.h"
#include "mercury/random_voxel.h"
#include "mercury/robot_file.h"
#include "tests/app/program.h"

namespace mercury::test {
namespace {

class NewCommand : public FolderTest {};

TEST_F(NewCommand, WritesTheRobotsOfASeed) {
  const Outcome outcome = succeeded(mercury({"new", "voxel", "-o", path("r"), "--count", "3", "--seed", "7"}));
  EXPECT_EQ(listing("r"), (std::vector<std::string>{"voxel-7-0.json", "voxel-7-1.json", "voxel-7-2.json"}));
  EXPECT_EQ(outcome.output,
            path("r/voxel-7-0.json") + "\n" + path("r/voxel-7-1.json") + "\n" + path("r/voxel-7-2.json") + "\n");
  EXPECT_EQ(load_robot(path("r/voxel-7-2.json")), random_voxel_robot({}, 7, 2));
}

TEST_F(NewCommand, OptionsShapeTheRobots) {
  succeeded(mercury({"new", "voxel", "-o", path("a.cbor"), "--voxels", "3x4x5", "--air", "0", "--edge", "0.2",
                     "--symmetry", "x", "--patch", "1"}));
  const RandomVoxelOptions options{
      .smallest = {3, 4, 5}, .largest = {3, 4, 5}, .edge = 0.2f, .air = 0, .mirror = Mirror::x, .patch = 1};
  EXPECT_EQ(load_robot(path("a.cbor")), random_voxel_robot(options, 1));
  EXPECT_EQ(load_robot(path("a.cbor")).masses.size(), 4u * 5 * 6);
}

TEST_F(NewCommand, FolderTakesTheChosenFormat) {
  succeeded(mercury({"new", "voxel", "-o", path("r/"), "--format", "cbor"}));
  EXPECT_EQ(listing("r"), std::vector<std::string>{"voxel-1-0.cbor"});
}

TEST_F(NewCommand, ExistingFilesAreReplacedOnlyWithForce) {
  write("a.json", "mine");
  const Arguments command{"new", "voxel", "-o", path("a.json")};
  EXPECT_THAT(mercury(command),
              Ends(2, "-o: " + path("a.json") + " exists already; use --force to replace it, or give another name"));
  EXPECT_EQ(read("a.json"), "mine");
  EXPECT_EQ(mercury(joined(command, {"--force"})).status, 0);
  EXPECT_EQ(load_robot(path("a.json")), random_voxel_robot({}, 1));
}

// The kept robots are those that move farthest in `run`.
TEST_F(NewCommand, BestOfKeepsTheFarthest) {
  const Outcome outcome =
      mercury({"new", "voxel", "-o", path("best"), "--count", "2", "--best-of", "12", "--seed", "2", "--seconds", "1"});
  ASSERT_EQ(outcome.status, 0) << outcome.messages;
  const auto report = nlohmann::json::parse(
      mercury({"run", "--random", "voxel:12", "--seed", "2", "--seconds", "1", "--trials", "3", "--json"}).output);
  std::vector<std::pair<double, std::string>> ranking;
  for (const auto& robot : report["robots"]) ranking.emplace_back(-robot["distance"].get<double>(), robot["name"]);
  std::sort(ranking.begin(), ranking.end());
  std::vector<std::string> best{ranking[0].second + ".json", ranking[1].second + ".json"};
  std::sort(best.begin(), best.end());
  EXPECT_EQ(listing("best"), best);
}

// The file has the lines that `run` writes for the same robots.
TEST_F(NewCommand, BestOfWritesEveryCandidate) {
  const std::vector<std::string> trial{"--seed", "2", "--seconds", "0.3", "--environment", "land", "--settle", "0.1"};
  std::vector<std::string> search{"new", "voxel", "-o", path("best/"), "--best-of", "6", "--csv", path("a.csv")};
  std::vector<std::string> run{"run", "--random", "voxel:6", "--trials", "3", "--csv", path("b.csv")};
  for (auto* command : {&search, &run}) {
    command->insert(command->end(), trial.begin(), trial.end());
    succeeded(mercury(*command));
  }
  EXPECT_EQ(read("a.csv"), read("b.csv"));
  const std::string csv = read("a.csv");
  EXPECT_EQ(std::count(csv.begin(), csv.end(), '\n'), 7);
}

// A search that is stopped writes the best robots so far: those of its CSV that went farthest.
TEST_F(NewCommand, InterruptedSearchKeepsTheBest) {
  const auto child = working_mercury({"new", "voxel", "-o", path("best/"), "--count", "2", "--best-of", "1000000",
                                      "--seconds", "0.1", "--device", "cpu", "--csv", path("a.csv")});
  const auto has_begun = testing::ContainsRegex("searching: [1-9]");
  while (child->running() && !testing::Value(child->messages(), has_begun)) nap();
  child->signal(SIGINT);
  const Outcome outcome = outcome_of(*child);
  EXPECT_EQ(outcome.status, 130);
  EXPECT_THAT(outcome.messages,
              testing::ContainsRegex("mercury: stopped after [0-9]+ of 1000000 candidates; the best of "
                                     "these are written\n"));
  std::vector<std::pair<double, std::string>> sound;
  std::istringstream csv(read("a.csv"));
  std::map<std::string, std::size_t> columns;
  for (std::string line; std::getline(csv, line);) {
    std::vector<std::string> fields;
    std::string field;
    for (std::istringstream rest(line); std::getline(rest, field, ',');) fields.push_back(field);
    if (columns.empty())
      for (const std::string& name : fields) columns.emplace(name, columns.size());
    else if (fields.at(columns.at("fate")) == "sound")
      sound.emplace_back(-std::stod(fields.at(columns.at("distance"))), fields.at(columns.at("name")));
  }
  ASSERT_GE(sound.size(), 2u);
  std::ranges::stable_sort(sound, {}, [](const auto& robot) { return robot.first; });
  std::vector<std::string> best{sound[0].second + ".json", sound[1].second + ".json"};
  std::ranges::sort(best);
  EXPECT_EQ(listing("best"), best);
}

// Both have begun with a name that is new. The first to finish has it.
TEST_F(NewCommand, TwoSearchesWithOneNewNameKeepBothRobots) {
  const auto child = working_mercury({"new", "voxel", "-o", path("a.json"), "--best-of", "1000000", "--seconds", "0.1",
                                      "--trials", "1", "--device", "cpu"});
  while (child->running() && !testing::Value(child->messages(), testing::ContainsRegex("searching: [1-9]"))) nap();
  write("a.json", "theirs");
  child->signal(SIGINT);
  const Outcome outcome = outcome_of(*child);
  EXPECT_EQ(outcome.status, 130);
  EXPECT_EQ(outcome.output, path("a-2.json") + "\n");
  EXPECT_THAT(outcome.messages, testing::HasSubstr("mercury: " + path("a.json") +
                                                   " was written by another program in the meantime; this one is " +
                                                   path("a-2.json") + "\n"));
  EXPECT_NO_THROW(load_robot(path("a-2.json")));
  EXPECT_EQ(read("a.json"), "theirs");
  EXPECT_EQ(listing(), (std::vector<std::string>{"a-2.json", "a.json"}));
}

TEST_F(NewCommand, ARobotThatAnotherProgramWroteMeanwhileIsKept) {
  // The last of many, while the first are written.
  const auto child = std::make_unique<ChildProcess>(
      MERCURY_PROGRAM, std::vector<std::string>{"new", "voxel", "-o", path("r/"), "--count", "300", "--quiet"});
  while (child->running() && !std::filesystem::exists(path("r/voxel-1-0.json"))) nap();
  write("r/voxel-1-299.json", "theirs");
  const Outcome outcome = outcome_of(*child);
  EXPECT_EQ(outcome.status, 1);
  EXPECT_EQ(outcome.messages, "mercury: " + path("r/voxel-1-299.json") +
                                  " was written by another program in the meantime; this one is " +
                                  path("r/voxel-1-299-2.json") + "\n");
  EXPECT_EQ(read("r/voxel-1-299.json"), "theirs");
  EXPECT_EQ(load_robot(path("r/voxel-1-299-2.json")), random_voxel_robot({}, 1, 299));
  EXPECT_EQ(listing("r").size(), 301u);
}

// What cannot be written is reported after everything else is.
TEST_F(NewCommand, AFailingCsvLosesNoRobot) {
  const Outcome outcome =
      mercury({"new", "voxel", "-o", path("best/"), "--best-of", "3", "--seconds", "0.1", "--csv", "/dev/full"});
  EXPECT_NE(outcome.status, 0);
  EXPECT_THAT(outcome.messages, testing::HasSubstr("/dev/full"));
  EXPECT_EQ(listing("best").size(), 1u);
}

TEST_F(NewCommand, RobotsNameTheEnvironmentOfTheirTrial) {
  succeeded(
      mercury({"new", "voxel", "-o", path("a.json"), "--best-of", "2", "--seconds", "0", "--environment", "land"}));
  EXPECT_EQ(environment_of(load_robot(path("a.json"))), "land");
  succeeded(mercury({"new", "voxel", "-o", path("b.json"), "--best-of", "2", "--seconds", "0"}));
  EXPECT_EQ(environment_of(load_robot(path("b.json"))), "ocean");
  succeeded(mercury({"new", "voxel", "-o", path("c.json")}));
  EXPECT_EQ(environment_of(load_robot(path("c.json"))), "");
}

TEST_F(NewCommand, InvalidInputIsReported) {
  write("file", "");
  const auto message = [&](const Arguments& arguments) {
    const Outcome outcome = mercury(joined({"new", "voxel"}, arguments));
    EXPECT_EQ(outcome.status, 2);
    return outcome.messages;
  };
  EXPECT_EQ(message({"-o", path("a.json"), "--count", "2"}),
            "mercury: -o: " + path("a.json") + " is one file; give a folder for several robots\n");
  EXPECT_EQ(message({"-o", path("a.txt")}),
            "mercury: -o: " + path("a.txt") + ": \".txt\" is not a robot file; give .json, .cbor or a folder\n");
  EXPECT_EQ(message({"-o", path("file")}), "mercury: -o: " + path("file") + " is a file, not a folder\n");
  EXPECT_EQ(message({"-o", path("r"), "--count", "0"}), "mercury: --count: 0 is not accepted; give 1 to 1000000\n");
  for (const char* count : {"1000001", "9223372036854775808", "18446744073709551615"})
    EXPECT_EQ(message({"-o", path("r"), "--count", count}),
              "mercury: --count: " + std::string(count) + " is not accepted; give 1 to 1000000\n");
  EXPECT_EQ(message({"-o", path("r"), "--count", "18446744073709551616"}),
            "mercury: --count: \"18446744073709551616\" is out of range; give a whole number of 0 or more\n");
  EXPECT_EQ(message({"-o", path("r"), "--count", "5", "--best-of", "3"}),
            "mercury: --best-of: 3 is not accepted; give at least --count, 5\n");
  EXPECT_EQ(message({"-o", path("r"), "--best-of", "3", "--seconds", "2", "--settle", "3"}),
            "mercury: --settle: 3 is not accepted; give 0 s or more, and less than the 2 s of --seconds\n");
  EXPECT_EQ(message({"-o", path("r"), "--csv", path("a.csv")}), "mercury: --csv: goes with --best-of N\n");
  EXPECT_EQ(message({"-o", path("r"), "--settle", "1"}), "mercury: --settle: goes with --best-of N\n");
  EXPECT_EQ(message({"-o", path("r"), "--best-of", "3", "--strain-limit", "0"}),
            "mercury: --strain-limit: 0 is not accepted; give a number > 0\n");
  EXPECT_EQ(message({"-o", path("r"), "--best-of", "3", "--csv", "-"}),
            "mercury: --csv: the names of the robots' files go to standard output; give a file\n");
  EXPECT_EQ(message({}), "mercury: --output is required; see mercury new voxel --help\n");
  EXPECT_EQ(listing(), std::vector<std::string>{"file"});
}

}  // namespace
}  // namespace mercury::test
