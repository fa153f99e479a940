// SPDX-License-Identifier: Apache-2.0
// What shells and scripts meet: streams that are closed or full, signals, exit status.
#include <gmock/gmock.h>
#include <signal.h>
#include <unistd.h>

#include "tests/app/program.h"

namespace mercury::test {
namespace {

using testing::HasSubstr;

// A short run of each command that needs no display. `prints`: its result goes to standard output.
struct ShortRun {
  const char* name;
  std::vector<std::string> arguments;  // "@" stands for the folder of the test
  bool prints = true;
};

const std::vector<ShortRun> short_runs{
    {"run", {"run", "@/a.json", "--seconds", "0.01", "--device", "cpu"}},
    {"render", {"render", "@/a.json", "--still", "0", "--size", "64x64", "--device", "cpu", "-o", "@/new.png"}, false},
    {"evolve", {"evolve", "@/run", "--population", "2", "--generations", "1", "--seconds", "0.01", "--device", "cpu"}},
    {"new", {"new", "voxel", "-o", "@/new/"}},
    {"mutate", {"mutate", "@/a.json", "-o", "@/mutated/"}},
    {"cross", {"cross", "@/a.json", "@/b.json", "-o", "@/crossed/"}},
    {"grow", {"grow", "@/a.json", "-o", "@/grown/"}},
    {"bench", {"bench", "--size", "2x2x2", "--count", "1", "--least-seconds", "0.001", "--device", "cpu"}},
    {"info", {"info", "@/a.json"}},
    {"machine", {"info"}},
    {"help", {"help"}},
    {"version", {"--version"}}};

void PrintTo(const ShortRun& run, std::ostream* out) { *out << run.name; }

class EveryCommand : public FolderTest, public testing::WithParamInterface<ShortRun> {
 protected:
  EveryCommand() {
    mercury({"new", "voxel", "-o", path("a.json"), "--seed", "1"});
    mercury({"new", "voxel", "-o", path("b.json"), "--seed", "2"});
  }

  // Through a shell, with redirections such as "2>&-".
  Outcome run_with(const std::string& redirections) const {
    std::vector<std::string> command{"-c", "exec \"$0\" \"$@\" " + redirections, MERCURY_PROGRAM};
    for (std::string argument : GetParam().arguments) {
      if (argument.starts_with("@")) argument.replace(0, 1, folder_.string());
      command.push_back(argument);
    }
    return run_program("sh", command);
  }
};

TEST_P(EveryCommand, WorksWithoutStandardInput) { EXPECT_EQ(run_with("<&-").status, 0); }

// Messages that nobody can read are dropped.
TEST_P(EveryCommand, WorksWhereMessagesCannotBeWritten) {
  for (const char* redirection : {"2>/dev/full -v", "2>&- -v"}) {
    const Outcome outcome = run_with(redirection);
    EXPECT_EQ(outcome.status, 0) << redirection;
    EXPECT_EQ(outcome.output.empty(), !GetParam().prints) << redirection;
    // The next run writes the same files.
    for (const char* written : {"new.png", "run", "new", "mutated", "crossed", "grown"})
      std::filesystem::remove_all(folder_ / written);
  }
}

// Results that nobody can read are an error, in one line.
TEST_P(EveryCommand, FailsWhereResultsCannotBeWritten) {
  for (const char* redirection : {">/dev/full", ">&-"}) {
    const Outcome outcome = run_with(redirection);
    EXPECT_EQ(outcome.status, GetParam().prints ? 1 : 0) << redirection << outcome.messages;
    const char* message = GetParam().prints ? "mercury: standard output cannot be written: " : "";
    EXPECT_THAT(outcome.messages, HasSubstr(message));
    for (const char* written : {"new.png", "run", "new", "mutated", "crossed", "grown"})
      std::filesystem::remove_all(folder_ / written);
  }
}

// A reader that has read enough, such as `head`, ends the program without a word, as it ends any other.
TEST_P(EveryCommand, EndsQuietlyWhenTheReaderLeaves) { EXPECT_EQ(run_with("-q | exit 0").messages, ""); }

// An output file never becomes standard error.
TEST_P(EveryCommand, WritesNoMessageIntoItsOutputFiles) {
  run_with("-v 2>&- >&-");
  for (const auto& entry : std::filesystem::recursive_directory_iterator(folder_)) {
    if (!entry.is_regular_file()) continue;
    std::ifstream file(entry.path(), std::ios::binary);
    const std::string content(std::istreambuf_iterator<char>(file), {});
    EXPECT_EQ(content.find("mercury: "), std::string::npos) << entry.path();
  }
}

INSTANTIATE_TEST_SUITE_P(Terminal, EveryCommand, testing::ValuesIn(short_runs),
                         [](const auto& tested) { return std::string(tested.param.name); });

// --- Names of robots

// `script` gives the program a terminal.
TEST_F(FolderTest, ResultsOnATerminalDoNotControlIt) {
  if (run_program("sh", {"-c", "command -v script"}).status != 0) GTEST_SKIP() << "no program `script`";
  write("a.json", R"({"format": "mercury-robot", "version": 1, "name": "a\u001b[31mb", "masses": [[0,0,0],[1,0,0]],
      "springs": [[0,1,21]], "faces": []})");
  const std::string command =
      std::string(MERCURY_PROGRAM) + " run " + path("a.json") + " --seconds 0.01 --device cpu -q --csv -";
  const Outcome on_terminal = run_program("script", {"-qec", command, "/dev/null"});
  EXPECT_EQ(on_terminal.status, 0) << on_terminal.output;
  EXPECT_THAT(on_terminal.output, HasSubstr("a\\x1b[31mb"));
  EXPECT_EQ(on_terminal.output.find('\x1b'), std::string::npos);
  EXPECT_EQ(on_terminal.output.find(" ... "), std::string::npos);                   // nothing is cut
  EXPECT_THAT(run_program("sh", {"-c", command}).output, HasSubstr("a\x1b[31mb"));  // into a pipe, every byte
}

// A first frame may take many seconds.
TEST_F(FolderTest, ATerminalShowsThatDrawingHasBegun) {
  if (run_program("sh", {"-c", "command -v script"}).status != 0) GTEST_SKIP() << "no program `script`";
  const std::string command = MERCURY_PROGRAM " render --random voxel --still 0 --size 64x64 -o " + path("a.png");
  const Outcome outcome = run_program("script", {"-qec", command, "/dev/null"});
  EXPECT_EQ(outcome.status, 0) << outcome.output;
  EXPECT_THAT(outcome.output, HasSubstr("  0 %  0/1 frames"));
}

// --- Values of options

TEST_F(FolderTest, AGpuIsNotMistakenForACpu) {
  EXPECT_THAT(mercury({"bench", "--device", "gpu"}), Ends(2, HasSubstr("did you mean cuda?")));
}

TEST_F(FolderTest, BenchRefusesATimeThatNeverEnds) {
  for (const char* seconds : {"1e23", "inf", "nan", "0"}) {
    EXPECT_THAT(mercury({"bench", "--least-seconds", seconds, "--device", "cpu"}),
                Ends(2, HasSubstr("--least-seconds: ")))
        << seconds;
  }
}

// --- Signals

// Runs a command that would take hours, sends a signal after its first message, and waits. Returns its wait status.
int status_after_signal(std::vector<std::string> arguments, int number) {
  int pipe_ends[2];
  EXPECT_EQ(pipe(pipe_ends), 0);
  arguments.insert(arguments.begin(), MERCURY_PROGRAM);
  arguments.emplace_back("-v");
  const pid_t child = fork();
  if (child == 0) {
    dup2(pipe_ends[1], STDERR_FILENO);
    close(pipe_ends[0]);
    close(pipe_ends[1]);
    if (!freopen("/dev/null", "w", stdout)) _exit(127);
    std::vector<char*> words;
    for (std::string& argument : arguments) words.push_back(argument.data());
    words.push_back(nullptr);
    execv(words[0], words.data());
    _exit(127);
  }
  close(pipe_ends[1]);
  char letters[4096];
  EXPECT_GT(read(pipe_ends[0], letters, 1), 0);
  kill(child, number);
  while (read(pipe_ends[0], letters, sizeof letters) > 0) {
  }
  close(pipe_ends[0]);
  int status = 0;
  waitpid(child, &status, 0);
  return WIFEXITED(status) ? WEXITSTATUS(status) : -WTERMSIG(status);
}

class Signals : public FolderTest, public testing::WithParamInterface<int> {};

TEST_P(Signals, EndWith128AndTheirNumber) {
  mercury({"new", "voxel", "-o", path("a.json"), "--seed", "1"});
  mercury({"new", "voxel", "-o", path("b.json"), "--seed", "2"});
  const std::vector<std::vector<std::string>> long_runs{
      {"run", path("a.json"), "--seconds", "1e6", "--device", "cpu"},
      {"run", "--random", "voxel:100000", "--seconds", "1e4", "--device", "cpu"},
      {"render", path("a.json"), "--seconds", "1e5", "--size", "64x64", "--device", "cpu", "-o", path("frames/")},
      {"evolve", path("run"), "--population", "8", "--generations", "100000", "--device", "cpu"},
      {"new", "voxel", "-o", path("new/"), "--count", "1000000"},
      {"new", "voxel", "-o", path("best/"), "--best-of", "1000000000", "--device", "cpu"},
      {"mutate", path("a.json"), "-o", path("mutated/"), "--count", "1000000"},
      {"cross", path("a.json"), path("b.json"), "-o", path("crossed/"), "--count", "1000000"}};
  for (const Arguments& arguments : long_runs)
    EXPECT_EQ(status_after_signal(arguments, GetParam()), 128 + GetParam()) << arguments[0] << " " << arguments[1];
}

INSTANTIATE_TEST_SUITE_P(Terminal, Signals, testing::Values(SIGINT, SIGTERM, SIGHUP), [](const auto& tested) {
  return tested.param == SIGINT ? "Interrupt" : tested.param == SIGTERM ? "Terminate" : "HangUp";
});

// As nohup starts it.
TEST_F(FolderTest, ASignalThatWasIgnoredAtTheStartStaysIgnored) {
  ChildProcess child("sh", {"-c", "trap '' HUP; exec \"$@\"", "sh", MERCURY_PROGRAM, "run", "--random", "voxel:1", "-v",
                            "--seconds", "1e6", "--device", "cpu"});
  while (child.running() && child.messages().empty()) nap();
  child.signal(SIGHUP);
  std::this_thread::sleep_for(std::chrono::milliseconds(800));  // others end it within half a second
  EXPECT_TRUE(child.running());
  child.signal(SIGTERM);
  EXPECT_EQ(outcome_of(child).status, 128 + SIGTERM);
}

}  // namespace
}  // namespace mercury::test
