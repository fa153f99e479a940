// SPDX-License-Identifier: Apache-2.0
// mercury run --record: the file, also when the run ends early or the disk is full.
#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>

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
  succeeded(mercury({"run", "--random", "voxel:3", "--seed", "5", "--seconds", "0.1", "--dt", "0.002", "--solver",
                     "xpbd", "--record", file(), "--every", "7"}));
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
  const Arguments arguments{"run", "--random", "voxel:2", "--seconds", "0.25", "--json"};
  auto without = nlohmann::json::parse(mercury(arguments).output),
       with = nlohmann::json::parse(mercury(joined(arguments, {"--record", file(), "--every", "3"})).output);
  EXPECT_EQ(with["robots"], without["robots"]);
}

TEST_F(RunRecord, WithoutEveryThereAreThirtyFramesPerSecond) {
  succeeded(mercury({"run", "--random", "voxel", "--seconds", "1", "--dt", "0.005", "--record", file()}));
  EXPECT_EQ(TrajectoryReader(file()).every(), 7);  // 1/30 s is 6.7 steps
}

TEST_F(RunRecord, FramesPerSecondThatCannotBeAreRefused) {
  const Arguments run{"run", "--random", "voxel", "--seconds", "0.1", "--dt", "0.005"};
  const auto refusal = [&](const Arguments& more) {
    const Outcome outcome = mercury(joined(run, more));
    EXPECT_EQ(outcome.status, 2);
    return outcome.messages;
  };
  EXPECT_THAT(refusal({"--record", file(), "--fps", "300"}),
              HasSubstr("--fps: 300 is not accepted; give more than 0 and "
                        "at most 200 frames/s, one per step"));
  EXPECT_THAT(refusal({"--record", file(), "--fps", "nan"}), HasSubstr("--fps"));
  EXPECT_THAT(refusal({"--record", file(), "--fps", "30", "--every", "2"}), HasSubstr("not together with --every"));
  EXPECT_THAT(refusal({"--fps", "30"}), HasSubstr("goes with --record"));
  EXPECT_THAT(listing(), testing::IsEmpty());
}

TEST_F(RunRecord, InterruptedRunLeavesTheFramesSoFar) {
  const auto child =
      working_mercury({"run", "--random", "voxel:2", "--seconds", "1e6", "--record", file(), "--every", "10"});
  child->signal(SIGINT);
  const Outcome outcome = outcome_of(*child);
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
  working_mercury({"run", "--random", "voxel:2", "--seconds", "1e6", "--record", file(), "--every", "10", "--force"})
      ->kill();
  EXPECT_EQ(read("a.h5"), "as it was");
}

class FullDisk : public RunRecord, public testing::WithParamInterface<int> {};

// Where the disk is full at once, while the robots are written, among the first frames, among later ones, and at the
// very end. The run takes less time than from one flush to the next.
TEST_P(FullDisk, IsReportedInOneLineAndTheFramesSoFarAreKept) {
#ifdef __SANITIZE_ADDRESS__
  GTEST_SKIP() << "the sanitizer wants to be loaded first";
#endif
  write("a.h5", "as it was");
  const Outcome outcome =
      run_program("env", {"NO_SPACE_AFTER=" + std::to_string(GetParam()), std::string("LD_PRELOAD=") + MERCURY_NO_SPACE,
                          MERCURY_PROGRAM, "run", "--random", "voxel:4", "--seconds", "0.2", "--record", file(),
                          "--every", "1", "--quiet", "--force", "--csv", path("a.csv")});
  EXPECT_EQ(outcome.status, 1);
  const bool has_frames = GetParam() >= 1'500'000;
  EXPECT_THAT(outcome.messages, testing::StartsWith("mercury: " + file() + ": the disk is full; " +
                                                    (has_frames ? "the first " : "nothing was kept")));
  EXPECT_EQ(std::ranges::count(outcome.messages, '\n'), 1) << outcome.messages;
  // The run goes on, and its results are printed and written.
  const bool went_on = outcome.messages.ends_with("the run goes on without a recording\n");
  EXPECT_EQ(went_on, GetParam() < 2'300'000) << outcome.messages;
  EXPECT_THAT(outcome.output, HasSubstr("voxel-1-3"));
  EXPECT_THAT(listing(), ElementsAre("a.csv", "a.h5"));
  EXPECT_THAT(read("a.csv"), HasSubstr("voxel-1-3"));
  if (!has_frames) {
    EXPECT_TRUE(read("a.h5") == "as it was");
    return;
  }
  TrajectoryReader reader(file());
  EXPECT_GE(reader.frames(), 50u) << "the first of four blocks";
  for (std::size_t frame = 0; frame < reader.frames(); ++frame)
    ASSERT_EQ(reader.step(frame), static_cast<std::int64_t>(frame));
}

INSTANTIATE_TEST_SUITE_P(After, FullDisk, testing::Values(0, 2000, 60'000, 500'000, 1'500'000, 2'300'000));

// Both begin with a name that is new.
TEST_F(RunRecord, TwoRunsWithOneNewNameKeepBothRecordings) {
  const auto started = [&](const char* seed) {
    return working_mercury(
        {"run", "--random", "voxel", "--seed", seed, "--seconds", "1e6", "--record", file(), "--every", "10"});
  };
  const auto first = started("1"), second = started("2");
  first->signal(SIGINT);
  EXPECT_EQ(outcome_of(*first).status, 128 + SIGINT);
  second->signal(SIGINT);
  EXPECT_THAT(outcome_of(*second).messages,
              HasSubstr(file() + " was written by another program in the meantime; this one is " + path("a-2.h5")));
  EXPECT_THAT(listing(), ElementsAre("a-2.h5", "a.h5"));
  EXPECT_EQ(TrajectoryReader(file()).seed(), 1u);
  EXPECT_EQ(TrajectoryReader(path("a-2.h5")).seed(), 2u);
}

TEST_F(RunRecord, TwoRunsWithOneNewNameKeepBothTables) {
  const auto started = [&](const char* seed) {
    return working_mercury({"run", "--random", "voxel", "--seed", seed, "--seconds", "1e6", "--csv", path("a.csv")});
  };
  const auto first = started("1"), second = started("2");
  first->signal(SIGINT);
  EXPECT_EQ(outcome_of(*first).status, 128 + SIGINT);
  second->signal(SIGINT);
  EXPECT_THAT(
      outcome_of(*second).messages,
      HasSubstr(path("a.csv") + " was written by another program in the meantime; this one is " + path("a-2.csv")));
  EXPECT_THAT(listing(), ElementsAre("a-2.csv", "a.csv"));
  EXPECT_THAT(read("a.csv"), HasSubstr("voxel-1-0"));
  EXPECT_THAT(read("a-2.csv"), HasSubstr("voxel-2-0"));
}

TEST_F(RunRecord, ALimitOfTheSizeOfFilesIsReportedInOneLine) {
  EXPECT_THAT(run_program("sh", {"-c",
                                 "ulimit -f 16; exec \"$0\" run --random voxel:4 --seconds 0.2 --every 1 "
                                 "--quiet --record \"$1\"",
                                 MERCURY_PROGRAM, file()}),
              Ends(1, testing::StartsWith(file() + ": the file grew beyond the size allowed here "
                                                   "(ulimit -f); nothing was kept")));
}

TEST_F(RunRecord, BadOptionsAreReportedInOneLine) {
  const auto messages = [&](const Arguments& more) {
    const Outcome outcome = mercury(joined({"run", "--random", "voxel", "--seconds", "0.01"}, more));
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
