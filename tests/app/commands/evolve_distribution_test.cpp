// SPDX-License-Identifier: Apache-2.0
// mercury evolve: runs that are killed, interrupted, or made by several processes end in the same lineage.
#include <gmock/gmock.h>
#include <signal.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <sstream>

#include "app/base/child_process.h"
#include "evolution/distribution/ranks.h"
#include "tests/app/commands/evolve_runs.h"
#include "tests/app/program.h"

namespace mercury::test {
namespace {

// Killed as soon as some generations are there, wherever it is at that moment, and resumed.
TEST_F(EvolveCommand, KilledRunsEndInTheSameLineage) {
  const std::string generations = "30", wanted = expected_lineage(generations);
  Arguments command = joined({"evolve", path("run")}, small(generations));
  int kills = 0;
  for (std::size_t target : {1, 3, 7, 12, 20}) {
    ChildProcess child(MERCURY_PROGRAM, command);
    wait_for_generations("run", target);
    child.kill();
    kills += outcome_of(child).status == 128 + SIGKILL;
    command = {"evolve", path("run"), "--resume", "--quiet"};
  }
  EXPECT_GT(kills, 0);
  succeeded(mercury(command));
  EXPECT_EQ(lineage("run"), wanted);
}

TEST_F(EvolveCommand, InterruptedRunsStopCleanlyAndGoOn) {
  const std::string generations = "40";
  ChildProcess child(MERCURY_PROGRAM, joined({"evolve", path("run")}, small(generations)));
  wait_for_generations("run", 2);
  child.signal(SIGINT);
  const Outcome outcome = outcome_of(child);
  ASSERT_EQ(outcome.status, 128 + SIGINT) << outcome.messages;
  EXPECT_THAT(outcome.messages, testing::EndsWith("mercury evolve " + path("run") + " --resume goes on\n"));
  EXPECT_THAT(listing("run"), testing::Contains("lineage.csv"));
  succeeded(evolve("run", {"--resume", "--quiet"}));
  EXPECT_EQ(lineage("run"), expected_lineage(generations));
}

TEST_F(EvolveCommand, ShardsEndInTheSameLineage) {
  succeeded(evolve("run", joined(small("2"), {"--prepare"})));
  for (int generation = 0; generation <= 2; ++generation) {
    for (const char* shard : {"3/3", "1/3", "2/3"}) succeeded(evolve("run", {"--shard", shard, "--quiet"}));
    succeeded(evolve("run", {"--merge"}));
  }
  EXPECT_EQ(lineage("run"), expected_lineage("2"));
  EXPECT_THAT(listing("run"), testing::Not(testing::Contains("shards")));
  EXPECT_THAT(evolve("run", {"--merge"}), Ends(2, path("run") + ": has all its 2 generations; mercury evolve " +
                                                      path("run") + " --merge --generations N raises their number"));
  succeeded(evolve("run", {"--merge", "--generations", "3"}));
  succeeded(evolve("run", {"--shard", "1/1", "--quiet"}));
  succeeded(evolve("run", {"--merge"}));
  EXPECT_EQ(lineage("run"), expected_lineage("3"));
}

TEST_F(EvolveCommand, IslandsAreTheSameInShards) {
  const Arguments islands = joined(small("3"), {"--islands", "2", "--migration-interval", "2", "--migrants", "1"});
  succeeded(evolve("whole", islands));
  succeeded(evolve("run", joined(islands, {"--prepare"})));
  for (int generation = 0; generation <= 3; ++generation) {
    for (const char* shard : {"1/2", "2/2"}) succeeded(evolve("run", {"--shard", shard, "--quiet"}));
    succeeded(evolve("run", {"--merge"}));
  }
  EXPECT_EQ(lineage("run"), lineage("whole"));
}

TEST_F(EvolveCommand, GrowingBrainsAreTheSameInShards) {
  succeeded(evolve("whole", growing("3")));
  succeeded(evolve("run", joined(growing("3"), {"--prepare"})));
  for (int generation = 0; generation <= 3; ++generation) {
    for (const char* shard : {"1/2", "2/2"}) succeeded(evolve("run", {"--shard", shard, "--quiet"}));
    succeeded(evolve("run", {"--merge"}));
  }
  EXPECT_EQ(lineage("run"), lineage("whole"));
}

// Wherever it is at that moment.
TEST_F(EvolveCommand, KilledRunsOfGrowingBrainsEndInTheSameLineage) {
  succeeded(evolve("whole", growing("12")));
  Arguments command = joined({"evolve", path("run")}, growing("12"));
  for (std::size_t target : {1, 4, 8}) {
    ChildProcess child(MERCURY_PROGRAM, command);
    wait_for_generations("run", target);
    child.kill();
    outcome_of(child);
    command = {"evolve", path("run"), "--resume", "--quiet"};
  }
  succeeded(mercury(command));
  EXPECT_EQ(lineage("run"), lineage("whole"));
}

TEST_F(EvolveCommand, RunsWhoseFolderWasRemovedEndWithALine) {
  for (const bool moved : {false, true}) {
    ChildProcess child(MERCURY_PROGRAM, joined({"evolve", path("run")}, small("100000")));
    wait_for_generations("run", 2);
    std::filesystem::rename(path("run"), path("moved"));
    if (!moved) std::filesystem::remove_all(path("moved"));
    const Outcome outcome = outcome_of(child);
    EXPECT_EQ(outcome.status, 2);
    EXPECT_EQ(std::ranges::count(outcome.messages, '\n'), 1) << outcome.messages;
    std::filesystem::remove_all(path("run"));
  }
  EXPECT_GE(generations_in("moved"), 2u);
}

TEST_F(EvolveCommand, MissingAndDamagedShardsAreNamed) {
  succeeded(evolve("run", joined(small("2"), {"--prepare"})));
  EXPECT_EQ(evolve("run", {"--merge"}).messages,
            "mercury: " + path("run/shards") + ": has no shard of generation 0; make them by --shard I/N\n");
  succeeded(evolve("run", {"--shard", "1/2", "--quiet"}));
  EXPECT_EQ(evolve("run", {"--merge"}).messages,
            "mercury: " + path("run/shards") + ": shard 2 of 2 of generation 0 is missing\n");
  const std::string whole = read("run/shards/0-1-of-2");
  for (std::size_t length : {std::size_t{0}, std::size_t{7}, whole.size() / 2, whole.size() - 1}) {
    write("run/shards/0-2-of-2", whole.substr(0, length));
    const Outcome outcome = evolve("run", {"--merge"});
    EXPECT_EQ(outcome.status, 2);
    EXPECT_THAT(outcome.messages, testing::StartsWith("mercury: " + path("run/shards/0-2-of-2") + ": is "));
    EXPECT_THAT(outcome.messages, testing::EndsWith("; remove it and run this shard again\n"));
  }
  EXPECT_EQ(generations_in("run"), 0u);
}

class EvolveByMpi : public EvolveCommand {
 protected:
  void SetUp() override {
    if (std::system("command -v mpirun > /dev/null") != 0) GTEST_SKIP() << "no mpirun on this machine";
    if (!Ranks::available()) GTEST_SKIP() << "a build without MPI";
    EvolveCommand::SetUp();
    setenv("OMPI_ALLOW_RUN_AS_ROOT", "1", 1);
    setenv("OMPI_ALLOW_RUN_AS_ROOT_CONFIRM", "1", 1);
  }
  // Ranks that are asked to end have `patience` seconds.
  static Arguments three_ranks(const Arguments& options, const std::string& patience = "1") {
    return joined(
        {"-n", "3", "--oversubscribe", "--mca", "odls_base_sigkill_timeout", patience, MERCURY_PROGRAM, "evolve"},
        options);
  }
  static std::size_t lines_of_mercury(const Outcome& outcome) {
    std::istringstream lines(outcome.messages);
    std::size_t count = 0;
    for (std::string line; std::getline(lines, line);) count += line.starts_with("mercury: ");
    return count;
  }
  // The process that evolves in the folder as that rank.
  static pid_t process_of(int rank, const std::string& folder) {
    for (const auto& entry : std::filesystem::directory_iterator("/proc")) {
      const auto text = [&](const char* file) {
        std::ifstream stream(entry.path() / file);
        return std::string(std::istreambuf_iterator<char>(stream), {});
      };
      const std::string end(1, '\0');
      if ((end + text("environ")).find(end + "OMPI_COMM_WORLD_RANK=" + std::to_string(rank) + end) !=
              std::string::npos &&
          text("cmdline").find(end + folder + end) != std::string::npos)
        return std::stoi(entry.path().filename());
    }
    return 0;
  }
};

TEST_F(EvolveByMpi, RanksEndInTheSameLineage) {
  succeeded(run_program("mpirun", three_ranks(joined({path("run")}, small()))));
  EXPECT_EQ(lineage("run"), expected_lineage());
}

TEST_F(EvolveByMpi, PipelinedRunsAreTheSameOnAllRanksAndWhenTheyGoOn) {
  const Arguments pipelined = joined(small("12"), {"--pipelined"});
  succeeded(evolve("whole", pipelined));
  succeeded(run_program("mpirun", three_ranks(joined({path("run")}, pipelined))));
  EXPECT_EQ(lineage("run"), lineage("whole"));
  // Interrupted with the next generation begun on all ranks.
  ChildProcess child("mpirun", three_ranks(joined({path("later")}, joined(small("4000"), {"--pipelined"}))));
  wait_for_generations("later", 3);
  child.signal(SIGINT);
  outcome_of(child);
  const std::size_t before = generations_in("later");
  succeeded(run_program(
      "mpirun", three_ranks({path("later"), "--resume", "--quiet", "--generations", std::to_string(before + 3)})));
  succeeded(evolve("alone", joined(small(std::to_string(before + 3)), {"--pipelined"})));
  EXPECT_EQ(lineage("later"), lineage("alone"));
}

TEST_F(EvolveByMpi, IslandsAreTheSameOnAllRanks) {
  const Arguments islands = joined(small("3"), {"--islands", "2", "--migration-interval", "2", "--migrants", "1"});
  succeeded(evolve("whole", islands));
  succeeded(run_program("mpirun", three_ranks(joined({path("run")}, islands))));
  EXPECT_EQ(lineage("run"), lineage("whole"));
}

TEST_F(EvolveByMpi, GrowingBrainsAreTheSameOnAllRanks) {
  succeeded(evolve("whole", growing("3")));
  succeeded(run_program("mpirun", three_ranks(joined({path("run")}, growing("3")))));
  EXPECT_EQ(lineage("run"), lineage("whole"));
}

TEST_F(EvolveByMpi, MistakesAreReportedOnce) {
  for (const Arguments& options : {Arguments{"--algorithm", "luck"},
                                   {"--charm", "3"},
                                   {"--resume"},
                                   {"--merge"},
                                   {"--prepare", "--trials", "0"}}) {
    const Outcome outcome = run_program("mpirun", three_ranks(joined({path("run")}, options)));
    EXPECT_EQ(outcome.status, 2) << outcome.messages;
    EXPECT_EQ(lines_of_mercury(outcome), 1u) << outcome.messages;
  }
  EXPECT_EQ(listing(), std::vector<std::string>{});
}

// On a busy machine, rank 0 may come upon the mistake seconds after the others.
TEST_F(EvolveByMpi, MistakesAreReportedByRankZeroHoweverLate) {
  const std::string late = "if [ $OMPI_COMM_WORLD_RANK = 0 ]; then sleep 6; fi; exec \"$@\"";
  const Outcome outcome = run_program("mpirun", {"-n", "3", "--oversubscribe", "sh", "-c", late, "sh", MERCURY_PROGRAM,
                                                 "evolve", path("run"), "--charm", "3"});
  EXPECT_EQ(outcome.status, 2) << outcome.messages;
  EXPECT_EQ(lines_of_mercury(outcome), 1u) << outcome.messages;
  EXPECT_THAT(outcome.messages, testing::HasSubstr("mercury: --charm: not an option"));
}

TEST_F(EvolveByMpi, ALostRankEndsTheRunWithALine) {
  const std::string generations = "40", wanted = expected_lineage(generations);
  for (const int lost : {1, 0}) {
    const std::string run = "without-" + std::to_string(lost);
    ChildProcess child("mpirun", three_ranks(joined({path(run)}, small(generations)), "2"));
    wait_for_generations(run, 2);
    const pid_t process = process_of(lost, path(run));
    ASSERT_GT(process, 0);
    ::kill(process, SIGKILL);
    const Outcome outcome = outcome_of(child);
    EXPECT_NE(outcome.status, 0);
    EXPECT_EQ(lines_of_mercury(outcome), 1u) << outcome.messages;
    EXPECT_THAT(outcome.messages, testing::HasSubstr("mercury: rank " + std::to_string(lost) + " no longer answers; "));
    for (const int rank : {0, 1, 2}) EXPECT_EQ(process_of(rank, path(run)), 0);
    succeeded(evolve(run, {"--resume", "--quiet"}));
    EXPECT_EQ(lineage(run), wanted);
  }
}

TEST_F(EvolveByMpi, PreparingAndMergingAreDoneOnce) {
  succeeded(run_program("mpirun", three_ranks(joined({path("run"), "--prepare"}, small("0")))));
  succeeded(evolve("run", {"--shard", "1/1", "--quiet"}));
  succeeded(run_program("mpirun", three_ranks({path("run"), "--merge"})));
  EXPECT_EQ(lineage("run"), expected_lineage("0"));
}

}  // namespace
}  // namespace mercury::test
