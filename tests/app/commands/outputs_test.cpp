// SPDX-License-Identifier: Apache-2.0
// What commands write, and what they leave alone.
#include <gmock/gmock.h>
#include <sys/stat.h>
#include <sys/sysmacros.h>

#include <future>

#include "mercury/random_voxel.h"
#include "mercury/robot_file.h"
#include "tests/app/program.h"
#include "tests/nap.h"

namespace mercury::test {
namespace {

using testing::HasSubstr;

// Every command that takes robots and writes, with what it reads; the output is still missing.
class Outputs : public FolderTest {
 protected:
  Outputs() { save_robot(path("eel.json"), eel_); }

  std::vector<std::string> run(const Arguments& more) const {
    return joined({"run", path("eel.json"), "--seconds", "0.01"}, more);
  }
  // A refused command would compute for days.
  std::string refusal(const Arguments& arguments) const {
    const Outcome outcome = mercury(arguments);
    EXPECT_EQ(outcome.status, 2) << outcome.messages;
    EXPECT_EQ(outcome.output, "");
    EXPECT_EQ(std::count(outcome.messages.begin(), outcome.messages.end(), '\n'), 1) << outcome.messages;
    return outcome.messages;
  }
  bool is_eel(const std::string& name) const { return load_robot(path(name)) == eel_; }

  const Robot eel_ = [] {
    Robot robot = random_voxel_robot({}, 1);
    robot.name = "eel";
    return robot;
  }();
};

// The device is the test's own where that is allowed: with a fault, the superuser would lose that of the machine.
TEST_F(Outputs, CsvGoesIntoADeviceWhichStays) {
  std::string device = path("null");
  if (mknod(device.c_str(), S_IFCHR | 0600, makedev(1, 3)) != 0) device = "/dev/null";
  const auto is_device = [&] {
    struct stat status {};
    return stat(device.c_str(), &status) == 0 && S_ISCHR(status.st_mode);
  };
  if (!is_device()) GTEST_SKIP() << "there are no devices";
  const Outcome ran = mercury(run({"--csv", device}));
  if (ran.messages.find("Permission denied") != std::string::npos) GTEST_SKIP() << "devices of tests cannot be opened";
  EXPECT_EQ(ran.status, 0) << ran.messages;
  EXPECT_TRUE(is_device());
  const Outcome measured =
      mercury({"bench", "--size", "1x1x1", "--count", "1", "--least-seconds", "0.001", "--csv", device});
  EXPECT_EQ(measured.status, 0) << measured.messages;
  EXPECT_TRUE(is_device());
}

TEST_F(Outputs, FullDeviceIsAFailureInOneLine) {
  for (const Arguments& command :
       {run({"--csv", "/dev/full"}),
        {"bench", "--size", "1x1x1", "--count", "1", "--least-seconds", "0.001", "--csv", "/dev/full"}}) {
    const Outcome outcome = mercury(command);
    EXPECT_EQ(outcome.status, 1);
    EXPECT_EQ(outcome.messages, "mercury: /dev/full: the disk is full\n");
    EXPECT_NE(outcome.output, "");  // the table is not lost
  }
  const Outcome printed =
      run_program("sh", {"-c", "exec \"$0\" run \"$1\" --seconds 0.01 >/dev/full", MERCURY_PROGRAM, path("eel.json")});
  EXPECT_EQ(printed.status, 1);
  EXPECT_EQ(printed.messages, "mercury: standard output cannot be written: the disk is full\n");
}

TEST_F(Outputs, CsvGoesThroughAPipe) {
  ASSERT_EQ(mkfifo(path("pipe").c_str(), 0600), 0);
  auto reader = std::async(std::launch::async, [this] { return read("pipe"); });
  succeeded(mercury(run({"--csv", path("pipe")})));
  const std::string csv = reader.get();
  EXPECT_THAT(csv, testing::StartsWith("index,name,"));
  EXPECT_THAT(csv, HasSubstr("\n0,eel,"));
  EXPECT_TRUE(std::filesystem::is_fifo(path("pipe")));
}

// Nobody reads; the results are printed, and the program ends.
TEST_F(Outputs, PipeWithoutReaderEndsAtCtrlC) {
  ASSERT_EQ(mkfifo(path("pipe").c_str(), 0600), 0);
  ChildProcess child(MERCURY_PROGRAM, run({"--csv", path("pipe"), "--json"}));
  while (child.output().empty()) nap();
  child.signal(SIGINT);
  EXPECT_EQ(outcome_of(child).status, 128 + SIGINT);
}

TEST_F(Outputs, ExistingFilesStayUnlessForced) {
  write("mine", "mine");
  const std::vector<std::vector<std::string>> commands{
      {"run", path("eel.json"), "--seconds", "1e6", "--csv", path("mine")},
      {"bench", "--least-seconds", "1e6", "--csv", path("mine")},
      {"render", path("eel.json"), "--seconds", "1e4", "-o", path("mine.mp4")},
      {"render", path("eel.json"), "--still", "1e6", "-o", path("mine.png")},
      {"render", path("eel.json"), "--seconds", "1e4", "--each", "-o", path("m.mp4")},
      {"run", path("eel.json"), "--seconds", "1e6", "--record", path("mine.h5")},
      {"new", "voxel", "--count", "1", "--best-of", "1000000000", "-o", path("mine.json")},
      {"new", "voxel", "--count", "1", "--best-of", "1000000000", "-o", path("folder")},
      {"new", "voxel", "--count", "1000000", "-o", path("folder")},
      {"mutate", path("eel.json"), "--count", "1000000", "-o", path("folder")},
      {"cross", path("eel.json"), path("eel.json"), "--count", "1000000", "-o", path("folder")},
      {"grow", path("eel.json"), "-o", path("mine.json")}};
  std::filesystem::create_directory(path("folder"));
  for (const char* name : {"mine.mp4", "mine.png", "m-eel.mp4", "mine.h5", "mine.json", "folder/voxel-1-400000.json",
                           "folder/eel-m999999.json", "folder/eel-x999999.json"})
    write(name, "mine");
  for (const Arguments& command : commands)
    EXPECT_THAT(refusal(command), HasSubstr("exists already; use --force to replace it")) << command[0];
  EXPECT_EQ(read("mine"), "mine");
  EXPECT_EQ(listing("folder").size(), 3u);
}

TEST_F(Outputs, OtherFilesInAFolderStay) {
  std::filesystem::create_directory(path("folder"));
  for (const char* name : {"folder/voxel-1-2.json", "folder/voxel-1-0.cbor", "folder/voxel-1-00.json", "folder/note"})
    write(name, "mine");
  succeeded(mercury({"new", "voxel", "--count", "2", "-o", path("folder")}));
  EXPECT_EQ(listing("folder"), (std::vector<std::string>{"note", "voxel-1-0.cbor", "voxel-1-0.json", "voxel-1-00.json",
                                                         "voxel-1-1.json", "voxel-1-2.json"}));
  EXPECT_EQ(read("folder/voxel-1-2.json"), "mine");
}

TEST_F(Outputs, ForceReplacesFiles) {
  write("a.csv", "mine");
  write("a.h5", "mine");
  succeeded(mercury(run({"--csv", path("a.csv"), "--record", path("a.h5"), "--force"})));
  EXPECT_NE(read("a.csv"), "mine");
  EXPECT_NE(read("a.h5"), "mine");
  EXPECT_EQ(listing(), (std::vector<std::string>{"a.csv", "a.h5", "eel.json"}));
}

TEST_F(Outputs, InputsAndProtectedFilesStayEvenIfForced) {
  EXPECT_EQ(refusal(run({"--csv", path("eel.json"), "--force"})),
            "mercury: --csv: " + path("eel.json") + " is a file that this command reads; give another name\n");
  EXPECT_THAT(refusal({"mutate", folder_.string(), "-o", path("eel.json"), "--force"}),
              HasSubstr("this command reads"));
  write("a.toml", "seconds = 0.01\n");
  EXPECT_THAT(refusal(run({"--config", path("a.toml"), "--csv", path("a.toml"), "--force"})),
              HasSubstr("this command reads"));
  succeeded(mercury(run({"--record", path("a.h5")})));
  std::filesystem::create_symlink(path("a.h5"), path("b.mp4"));
  EXPECT_THAT(refusal({"render", path("a.h5"), "-o", path("b.mp4"), "--force"}), HasSubstr("this command reads"));
  EXPECT_TRUE(is_eel("eel.json"));
  write("a.csv", "mine");
  chmod(path("a.csv").c_str(), 0444);
  EXPECT_EQ(refusal(run({"--csv", path("a.csv"), "--force"})),
            "mercury: --csv: " + path("a.csv") + " is write-protected; give another name\n");
  EXPECT_EQ(read("a.csv"), "mine");
}

TEST_F(Outputs, TwoOutputsAreTwoFiles) {
  EXPECT_EQ(refusal(run({"--csv", path("a.h5"), "--record", path("a.h5")})),
            "mercury: --csv, --record: " + path("a.h5") + " is named twice; give each output a name of its own\n");
}

TEST_F(Outputs, RobotsGoThroughLinksAndToStandardOutput) {
  std::filesystem::create_symlink(path("there.json"), path("link.json"));
  succeeded(mercury({"new", "voxel", "-o", path("link.json")}));
  EXPECT_TRUE(std::filesystem::is_symlink(path("link.json")));
  EXPECT_EQ(load_robot(path("there.json")), random_voxel_robot({}, 1));
  const Outcome printed = succeeded(mercury({"new", "voxel", "-o", "-"}));
  EXPECT_EQ(parse_robot(printed.output, RobotFormat::json), random_voxel_robot({}, 1));
  const Outcome binary = mercury({"grow", path("eel.json"), "-o", "/dev/stdout", "--format", "cbor"});
  EXPECT_EQ(parse_robot(binary.output, RobotFormat::cbor), eel_);
}

// A name in a file is no path.
TEST_F(Outputs, RobotsInAFolderAreNotWrittenThroughLinksOutOfIt) {
  std::filesystem::create_directory(path("folder"));
  write("mine", "mine");
  std::filesystem::create_symlink(path("mine"), path("folder/voxel-1-0.json"));
  const Arguments command{"new", "voxel", "--count", "1", "--force", "-o", path("folder")};
  EXPECT_THAT(refusal(command), HasSubstr("voxel-1-0.json: is a link out of " + path("folder")));
  EXPECT_EQ(read("mine"), "mine");
}

// Neither what is there is replaced, nor a new file made where a link leads.
TEST_F(Outputs, FilesThatTheProgramNamesAreNotWrittenThroughLinks) {
  write("world.json", R"({"grid_width": 3, "grid_height": 3, "objects": {"box": {"indices": [1], "types": [2]}}})");
  const std::string eel = path("eel.json"), name = eel_.name;
  const std::vector<std::pair<std::string, std::vector<std::string>>> cases{
      {name + ".obj", {"export", eel, "--format", "obj", "-o", path("folder")}},
      {name + ".mtl", {"export", eel, "--format", "obj", "-o", path("folder")}},
      {"own.mtl", {"export", eel, "-o", path("folder/own.obj")}},
      {"world.toml", {"import", path("world.json"), "-o", path("folder")}},
      {"world-box.json", {"import", path("world.json"), "-o", path("folder")}},
      {"frame-00000.png", {"render", eel, "--seconds", "0.05", "--size", "64x64", "-o", path("folder")}},
      {"a-" + name + ".png", {"render", eel, "--each", "--still", "0", "--size", "64x64", "-o", path("folder/a.png")}}};
  for (const bool exists : {true, false})
    for (auto [link, command] : cases) {
      std::filesystem::remove_all(path("folder"));
      std::filesystem::remove(path("mine"));
      std::filesystem::create_directory(path("folder"));
      if (exists) write("mine", "mine");
      std::filesystem::create_symlink(path("mine"), path("folder/" + link));
      command.emplace_back("--force");
      EXPECT_THAT(refusal(command), HasSubstr(link + ": is a link out of " + path("folder"))) << command[0] << link;
      EXPECT_EQ(std::filesystem::exists(path("mine")), exists) << command[0] << link;
      if (exists) {
        EXPECT_EQ(read("mine"), "mine") << command[0] << link;
      }
    }
}

TEST_F(Outputs, NamesOfRobotsLeadToNoOtherFolder) {
  Robot robot = eel_;
  robot.name = "../outside\n";
  save_robot(path("eel.json"), robot);
  succeeded(mercury({"grow", path("eel.json"), "-o", path("inside/")}));
  EXPECT_EQ(listing("inside"), std::vector<std::string>{"_outside_.json"});
  EXPECT_EQ(listing(), (std::vector<std::string>{"eel.json", "inside"}));
}

TEST_F(Outputs, TwoRobotsOfOneNameAreNotGrownIntoOneFile) {
  save_robot(path("other.json"), eel_);
  EXPECT_EQ(refusal({"grow", path("eel.json"), path("other.json"), "-o", path("folder/")}),
            "mercury: eel: two robots have this name; grow them into different folders\n");
}

// The answer of a user at a terminal, given by a program that plays one.
TEST_F(Outputs, AnswerOnATerminalReplaces) {
  write("a.csv", "mine");
  const auto answer = [&](const std::string& text) {
    const std::string script =
        "import os, pty, sys\n"
        "child, terminal = pty.fork()\n"
        "if child == 0: os.execv(sys.argv[2], sys.argv[2:])\n"
        "shown = b''\n"
        "while b'[y/N]' not in shown: shown += os.read(terminal, 1000)\n"
        "os.write(terminal, sys.argv[1].encode())\n"
        "try:\n"
        "  while part := os.read(terminal, 1000): shown += part\n"
        "except OSError: pass\n"
        "sys.stdout.write(shown.decode())\n"
        "sys.exit(os.waitstatus_to_exitcode(os.waitpid(child, 0)[1]))\n";
    std::vector<std::string> arguments{"-c", script, text, MERCURY_PROGRAM};
    for (const std::string& argument : run({"--csv", path("a.csv")})) arguments.push_back(argument);
    return run_program("python3", arguments);
  };
  const Outcome refused = answer("n\n");
  EXPECT_EQ(refused.status, 2) << refused.messages;
  EXPECT_THAT(refused.output, HasSubstr("mercury: " + path("a.csv") + " exists; replace it? [y/N] "));
  EXPECT_EQ(read("a.csv"), "mine");
  EXPECT_EQ(answer("\x03").status, 128 + SIGINT);
  EXPECT_EQ(read("a.csv"), "mine");
  EXPECT_EQ(answer("y\n").status, 0);
  EXPECT_THAT(read("a.csv"), testing::StartsWith("index,name,"));
}

// --- --dry-run

TEST_F(Outputs, DryRunsSayWhatWouldBeDoneAndWriteNothing) {
  const std::vector<std::pair<std::vector<std::string>, std::vector<std::string>>> commands{
      {{"run", path("eel.json"), "--random", "voxel:3", "--seconds", "2", "--dt", "0.002", "--csv", path("x/a.csv"),
        "--record", path("x/a.h5"), "--every", "10"},
       {"4: ", "2 s: 1000 steps of 0.002 s", path("x/a.h5") + ": 101 frames", path("x/a.csv")}},
      {{"run", "--random", "voxel:1000", "--seconds", "1"}, {"1000: about "}},
      {{"render", path("eel.json"), "--seconds", "2", "--fps", "10", "--size", "161x91", "-o", path("x/A.MP4")},
       {"20 frames of 162x92", path("x/A.MP4"), "1: " + std::to_string(eel_.masses.size()) + " masses"}},
      {{"render", path("eel.json"), "-o", path("frames/")}, {"300 frames of 1280x720", path("frames/")}},
      {{"new", "voxel", "--count", "5", "--seed", "9", "-o", path("x/")}, {"5 of seed 9", "the folder " + path("x/")}},
      {{"new", "voxel", "--count", "1", "-o", path("X.CBOR")}, {path("X.CBOR") + "\n"}},
      {{"new", "voxel", "--best-of", "70", "--seconds", "3", "-o", path("x.json")}, {"70 of seed 1", "3000 steps"}},
      {{"mutate", path("eel.json"), "--count", "5", "-o", path("x/")}, {"5 mutants of seed 1"}},
      {{"cross", path("eel.json"), path("eel.json"), "-o", path("x/")}, {"1 child of seed 1"}},
      {{"grow", path("eel.json"), "-o", path("x.json")}, {path("x.json")}},
      {{"evolve", path("swim"), "--population", "10", "--generations", "4", "--seconds", "5"},
       {"50: 10 at first, then 10 in each of 4 generations", "5000 steps", "the folder " + path("swim")}}};
  for (const auto& [command, texts] : commands) {
    const Outcome outcome = succeeded(mercury(joined(command, {"--dry-run"})));
    EXPECT_EQ(outcome.messages, "");
    EXPECT_THAT(outcome.output, testing::StartsWith("dry run of mercury " + command[0]));
    for (const std::string& text : texts) EXPECT_THAT(outcome.output, HasSubstr(text)) << command[0];
    EXPECT_EQ(listing(), std::vector<std::string>{"eel.json"}) << command[0];
  }
}

TEST_F(Outputs, DryRunsFindWhatIsWrong) {
  write("a.csv", "mine");
  EXPECT_THAT(refusal(run({"--csv", path("a.csv"), "--dry-run"})), HasSubstr("exists already"));
  EXPECT_THAT(refusal({"run", path("none.json"), "--dry-run"}), HasSubstr("none.json"));
  EXPECT_THAT(refusal({"render", path("eel.json"), "--size", "0x5", "-o", path("a.mp4"), "--dry-run"}),
              HasSubstr("--size"));
  EXPECT_THAT(refusal({"evolve", folder_.string(), "--dry-run"}), HasSubstr("is not empty; give a new folder"));
}

}  // namespace
}  // namespace mercury::test
