// SPDX-License-Identifier: Apache-2.0
// mercury run --record: the file, also when the run ends early or the disk is full.
#include <gmock/gmock.h>

#include <cmath>
#include <thread>

#include "app/recording/trajectory_reader.h"
#include "mercury/simulation.h"
#include "tests/app/program.h"

namespace mercury::test {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

class RunRecord : public FolderTest {
 protected:
  std::string file() const { return path("a.h5"); }
};

TEST_F(RunRecord, RecordsEveryNStepsAndTheSeed) {
  const Outcome outcome = mercury({"run", "--random", "voxel:3", "--seed", "5", "--seconds", "0.1", "--dt", "0.002",
                                   "--solver", "xpbd", "--record", file(), "--every", "7"});
  ASSERT_EQ(outcome.status, 0) << outcome.messages;
  EXPECT_THAT(listing(), ElementsAre("a.h5"));
  const TrajectoryReader reader(file());
  ASSERT_EQ(reader.frames(), 8u);  // 0, 7, ..., 49 of 50 steps
  EXPECT_EQ(reader.step(7), 49);
  EXPECT_DOUBLE_EQ(reader.time(7), 49 * 0.002);
  EXPECT_EQ(reader.seed(), 5u);
  EXPECT_EQ(reader.every(), 7);
  EXPECT_EQ(reader.configuration().solver, Solver::xpbd);
  EXPECT_EQ(reader.robots().at(2).robot.name, "voxel-5-2");
}

TEST_F(RunRecord, RecordingDoesNotChangeTheRun) {
  const std::vector<std::string> arguments{"run", "--random", "voxel:2", "--seconds", "0.25", "--json"};
  std::vector<std::string> recorded = arguments;
  recorded.insert(recorded.end(), {"--record", file(), "--every", "3"});
  auto without = nlohmann::json::parse(mercury(arguments).output),
       with = nlohmann::json::parse(mercury(recorded).output);
  EXPECT_EQ(with["robots"], without["robots"]);
}

TEST_F(RunRecord, WithoutEveryThereAreThirtyFramesPerSecond) {
  ASSERT_EQ(mercury({"run", "--random", "voxel", "--seconds", "1", "--dt", "0.005", "--record", file()}).status, 0);
  EXPECT_EQ(TrajectoryReader(file()).every(), 7);  // 1/30 s is 6.7 steps
}

TEST_F(RunRecord, InterruptedRunLeavesTheFramesSoFar) {
  ChildProcess child(MERCURY_PROGRAM,
                     {"run", "--random", "voxel:2", "--seconds", "1e6", "--record", file(), "--every", "10"});
  while (child.messages().empty()) std::this_thread::yield();  // progress shows that it simulates
  child.signal(SIGINT);
  const Outcome outcome = outcome_of(child);
  EXPECT_EQ(outcome.status, 128 + SIGINT);
  EXPECT_THAT(listing(), ElementsAre("a.h5"));
  TrajectoryReader reader(file());
  ASSERT_GT(reader.frames(), 1u);
  for (std::size_t frame = 0; frame < reader.frames(); ++frame) {
    ASSERT_EQ(reader.step(frame), static_cast<std::int64_t>(10 * frame));
    for (const Vec3 position : reader.positions(frame)) ASSERT_TRUE(std::isfinite(length(position)));
  }
}

TEST_F(RunRecord, KilledRunLeavesNoFileOfThatName) {
  write("a.h5", "as it was");
  ChildProcess child(MERCURY_PROGRAM,
                     {"run", "--random", "voxel:2", "--seconds", "1e6", "--record", file(), "--every", "10"});
  while (child.messages().empty()) std::this_thread::yield();
  child.kill();
  EXPECT_EQ(read("a.h5"), "as it was");
}

class FullDisk : public RunRecord, public testing::WithParamInterface<int> {};

// Where the disk is full at once, while the robots are written, among the frames, and at the very end.
TEST_P(FullDisk, IsReportedInOneLine) {
#ifdef __SANITIZE_ADDRESS__
  GTEST_SKIP() << "the sanitizer wants to be loaded first";
#endif
  write("a.h5", "as it was");
  const Outcome outcome =
      run_program("env", {"NO_SPACE_AFTER=" + std::to_string(GetParam()), std::string("LD_PRELOAD=") + MERCURY_NO_SPACE,
                          MERCURY_PROGRAM, "run", "--random", "voxel:4", "--seconds", "0.2", "--record", file(),
                          "--every", "1", "--quiet", "--force"});
  EXPECT_EQ(outcome.status, 1);
  EXPECT_EQ(outcome.messages, "mercury: " + file() + ": the disk is full; nothing was kept\n");
  EXPECT_THAT(listing(), ElementsAre("a.h5"));
  EXPECT_TRUE(read("a.h5") == "as it was");
}

INSTANTIATE_TEST_SUITE_P(After, FullDisk, testing::Values(0, 2000, 60'000, 500'000, 1'500'000, 2'300'000));

TEST_F(RunRecord, BadOptionsAreReportedInOneLine) {
  const auto messages = [&](const std::vector<std::string>& more) {
    std::vector<std::string> arguments{"run", "--random", "voxel", "--seconds", "0.01"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    const Outcome outcome = mercury(arguments);
    EXPECT_EQ(outcome.status, 2);
    EXPECT_EQ(outcome.output, "");
    return outcome.messages;
  };
  EXPECT_EQ(
      messages({"--record", path("a.txt")}),
      "mercury: --record: \"" + path("a.txt") + "\" is not accepted; give a name that ends in .h5, .hdf5 or .h5md\n");
  write("no", "");
  EXPECT_EQ(messages({"--record", path("no/a.h5")}),
            "mercury: --record: " + path("no/a.h5") + " cannot be written: " + path("no") + " is no folder\n");
  std::filesystem::create_directory(path("folder.h5"));
  EXPECT_EQ(messages({"--record", path("folder.h5")}),
            "mercury: --record: " + path("folder.h5") + " is a folder; give a file\n");
  EXPECT_EQ(messages({"--record", file(), "--every", "0"}),
            "mercury: --every: 0 is not accepted; give a number of steps, 1 or more\n");
  EXPECT_EQ(messages({"--every", "5"}), "mercury: --every: goes with --record FILE.h5\n");
  EXPECT_EQ(messages({"--compress"}), "mercury: --compress: goes with --record FILE.h5\n");
}

}  // namespace
}  // namespace mercury::test
