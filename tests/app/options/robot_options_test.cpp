// SPDX-License-Identifier: Apache-2.0
// The robots that a command works on, loaded at once or made on demand.
#include "app/options/robot_options.h"

#include "mercury/error.h"
#include "mercury/robot_file.h"
#include "tests/app/program.h"

namespace mercury::test {
namespace {

class RobotOptionsTest : public FolderTest {
 protected:
  RobotOptionsTest() { options_.add_to(tree_.root()); }
  const RobotOptions& parsed(const std::vector<std::string>& arguments) {
    tree_.parse(arguments);
    return options_;
  }

 private:
  CommandTree tree_;
  RobotOptions options_;
};

// A folder may be named like a command.
TEST(CommandTree, WordsAfterACommandAreNoCommands) {
  CommandTree tree("mercury", "");
  std::vector<std::string> words, other;
  std::string chosen;
  const Command first = tree.root().add_command("export", "");
  first.add_list("ROBOTS", words, "");
  first.when_chosen([&] { chosen += "export"; });
  const Command second = tree.root().add_command("run", "");
  second.add_list("ROBOTS", other, "");
  second.when_chosen([&] { chosen += "run"; });
  tree.parse({"export", "run", "export"});
  EXPECT_EQ(words, (std::vector<std::string>{"run", "export"}));
  EXPECT_EQ(chosen, "export");
}

TEST_F(RobotOptionsTest, SequenceMakesTheRobotsThatLoadReturns) {
  Robot robot{.name = "pair", .masses = {{0, 0, 0}, {1, 0, 0}}, .origin = R"({"environment":"land"})"};
  robot.springs.push_back({.a = 0, .b = 1, .material = 1, .rest_length = 1});
  save_robot(path("pair.json"), robot);
  const RobotOptions& options =
      parsed({path("pair.json"), "--random", "voxel:3:7:40", "--random", "shell:2", "--seed", "5"});
  const LoadedRobots loaded = options.load({});
  const auto& expected = loaded.robots;
  ASSERT_EQ(expected.size(), 6u);
  const RobotSequence sequence = options.sequence();
  ASSERT_EQ(sequence.count, expected.size());
  for (std::size_t i = expected.size(); i-- > 0;) EXPECT_EQ(*sequence.source(i), *expected[i]);
  EXPECT_EQ(sequence.source(6), nullptr);
  EXPECT_EQ(sequence.files, std::vector<std::filesystem::path>{path("pair.json")});
  EXPECT_EQ(loaded.files, sequence.files);
  EXPECT_EQ(loaded.environments, sequence.environments);
  EXPECT_EQ(sequence.environments, (std::vector<std::string>{"land", "", "ocean"}));
}

TEST_F(RobotOptionsTest, NoRobotsAreBadInput) {
  const RobotOptions& options = parsed({});
  EXPECT_THROW(options.sequence(), InputError);
}

}  // namespace
}  // namespace mercury::test
