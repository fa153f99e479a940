// SPDX-License-Identifier: Apache-2.0
// Network robots on the command line.
#include <gmock/gmock.h>

#include <algorithm>

#include "mercury/nn_robot.h"
#include "mercury/robot_file.h"
#include "tests/app/program.h"

namespace mercury::test {
namespace {

using testing::HasSubstr;

class NnCommand : public FolderTest {};

TEST_F(NnCommand, NewWritesTheRobotsOfASeed) {
  for (const std::string format : {"json", "cbor"}) {
    succeeded(mercury(
        {"new", "nn", "-o", path(format), "--count", "2", "--seed", "7", "--points", "100", "--format", format}));
    EXPECT_EQ(listing(format), (std::vector<std::string>{"nn-7-0." + format, "nn-7-1." + format}));
    const Robot robot = load_robot(path(format + "/nn-7-1." + format));
    EXPECT_EQ(robot, random_nn_robot({.points = 100}, 7, 1));
    EXPECT_EQ(grow(*nn_genome_of(robot), robot.name), robot);
  }
}

TEST_F(NnCommand, OptionsShapeTheRobots) {
  succeeded(mercury({"new", "nn", "-o", path("a.json"), "--points", "200", "--hidden", "20,30", "--alpha", "0.5",
                     "--mirrored", "1"}));
  const NnOptions options{.hidden = {20, 30}, .points = 200, .alpha = 0.5f, .mirrored = 1};
  EXPECT_EQ(load_robot(path("a.json")), random_nn_robot(options, 1));
}

TEST_F(NnCommand, FailedRobotIsReportedAndTheNextOneIsMade) {
  // With this small radius, some of the clouds have no tetrahedron.
  const Outcome outcome =
      mercury({"new", "nn", "-o", path("r"), "--count", "30", "--points", "64", "--alpha", "0.05", "--spacing", "0"});
  EXPECT_EQ(outcome.status, 1);
  EXPECT_THAT(outcome.messages, HasSubstr("alpha: no tetrahedron of the cloud is as small as the given radius"));
  EXPECT_GT(listing("r").size(), 0u);
  EXPECT_LT(listing("r").size(), 30u);
}

TEST_F(NnCommand, RandomRobotsAreSimulated) {
  const Outcome outcome =
      mercury({"run", "--random", "nn:2", "--points", "64", "--spacing", "0", "--seconds", "0.05", "--json"});
  ASSERT_EQ(outcome.status, 0) << outcome.messages;
  const auto report = nlohmann::json::parse(outcome.output);
  ASSERT_EQ(report["robots"].size(), 2u);
  EXPECT_EQ(report["robots"][1]["name"], "nn-1-1");
  EXPECT_EQ(report["robots"][1]["masses"], 64);
  EXPECT_GT(report["robots"][1]["largest_strain"], 0.);
}

TEST_F(NnCommand, RunLeavesOutRobotsThatCannotBeMade) {
  const std::vector<std::string> shape{"--points", "64", "--alpha", "0.05", "--spacing", "0"};
  std::vector<std::string> make{"new", "nn", "-o", path("r"), "--count", "30"};
  std::vector<std::string> run{"run", "--random", "nn:30", "--seconds", "0.01", "--json"};
  for (auto* arguments : {&make, &run}) arguments->insert(arguments->end(), shape.begin(), shape.end());
  mercury(make);
  const Outcome outcome = mercury(run);
  EXPECT_EQ(outcome.status, 1);  // some are missing
  std::vector<std::string> names;
  const auto report = nlohmann::json::parse(outcome.output);
  EXPECT_EQ(report["robots"].size(), 30u);
  for (const auto& robot : report["robots"]) {
    EXPECT_EQ(robot["failure"].is_null(), robot["fate"] != "failed");
    EXPECT_EQ(robot["distance"].is_null(), robot["fate"] == "failed");
    if (robot["fate"] != "failed") names.push_back(robot["name"].get<std::string>() + ".json");
  }
  EXPECT_THAT(names, testing::UnorderedElementsAreArray(listing("r")));
  const std::string reason = " was left out: alpha: no tetrahedron of the cloud is as small as the given radius\n";
  for (int i = 0; i < 30; ++i) {
    const std::string name = "nn-1-" + std::to_string(i);
    EXPECT_EQ(outcome.messages.find("mercury: " + name + reason) != std::string::npos,
              std::ranges::count(names, name + ".json") == 0);
  }
}

TEST_F(NnCommand, InvalidInputIsReported) {
  const auto message = [&](const Arguments& arguments) {
    const Outcome outcome = mercury(joined({"run", "--random", "nn:2", "--seconds", "0"}, arguments));
    EXPECT_EQ(outcome.status, 2);
    return outcome.messages;
  };
  EXPECT_EQ(message({"--points", "10"}), "mercury: --points: 10 is not accepted; give 64 to 65535\n");
  EXPECT_EQ(message({"--hidden", "64,x"}), "mercury: --hidden: \"x\" is not accepted; give a whole number\n");
  EXPECT_EQ(message({"--hidden", "64,2"}), "mercury: --hidden: 2 is not accepted; give 6 to 4096\n");
  EXPECT_EQ(
      message({"--alpha", "1e-6"}),
      "mercury: --random: none could be grown: alpha: no tetrahedron of the cloud is as small as the given radius\n");
}

}  // namespace
}  // namespace mercury::test
