// SPDX-License-Identifier: Apache-2.0
// How commands read robots: files, folders, standard input, and what they refuse before it costs memory.
#include <gmock/gmock.h>
#include <sys/stat.h>

#include <csignal>

#include "mercury/random_voxel.h"
#include "mercury/robot_file.h"
#include "tests/app/program.h"

namespace mercury::test {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::StartsWith;

class Inputs : public FolderTest {
 protected:
  Inputs() {
    for (const char* name : {"r", "r/inner"}) std::filesystem::create_directory(path(name));
    for (std::uint64_t i = 0; i < 3; ++i)
      save_robot(path(i < 2 ? "r/" + std::to_string(i) + ".JSON" : "r/inner/2.cbor"), random_voxel_robot({}, 7, i));
  }

  static std::vector<std::string> names_in(const Outcome& outcome) {
    std::vector<std::string> names;
    const auto json = nlohmann::json::parse(outcome.output);
    for (const auto& robot : json["robots"]) names.push_back(robot["name"]);
    return names;
  }
  static Outcome with_input(const Arguments& arguments, const std::string& input) {
    ChildProcess child(MERCURY_PROGRAM, arguments);
    child.write(std::span(reinterpret_cast<const std::uint8_t*>(input.data()), input.size()));
    return outcome_of(child);
  }
  // `limit`: as ulimit takes it.
  static Outcome limited(const std::string& limit, const std::string& arguments) {
    return run_program("/bin/sh", {"-c", "ulimit " + limit + " && exec " MERCURY_PROGRAM " " + arguments});
  }
  // With limited address space [kB].
  static Outcome limited(long kilobytes, const std::string& arguments) {
    return limited("-v " + std::to_string(kilobytes), arguments);
  }
  const std::vector<std::string> brief_{"--device", "cpu", "--seconds", "0.01"};
  std::vector<std::string> run(std::vector<std::string> arguments) const { return joined({"run"}, arguments, brief_); }
  std::vector<std::string> run_json(std::vector<std::string> arguments) const {
    return run(std::move(joined(arguments, {"--json"})));
  }
};

TEST_F(Inputs, FoldersInsideFoldersAreReadWithRecursive) {
  EXPECT_THAT(names_in(mercury(run_json({path("r")}))), ElementsAre("voxel-7-0", "voxel-7-1"));
  EXPECT_THAT(names_in(mercury(run_json({path("r"), "--recursive"}))),
              ElementsAre("voxel-7-0", "voxel-7-1", "voxel-7-2"));
}

TEST_F(Inputs, StandardInputHoldsRobots) {
  const std::string json = read("r/0.JSON") + read("r/1.JSON"), cbor = read("r/inner/2.cbor");
  EXPECT_THAT(names_in(with_input(run_json({"-"}), json)), ElementsAre("voxel-7-0", "voxel-7-1"));
  EXPECT_THAT(names_in(with_input(run_json({"-", path("r/0.JSON")}), cbor)), ElementsAre("voxel-7-2", "voxel-7-0"));
  EXPECT_THAT(with_input(run({"-"}), "\n"), Ends(2, "standard input: holds no robot"));
  EXPECT_THAT(with_input(run({"-"}), json + "{}"), Ends(2, StartsWith("standard input: document 3: ")));
  EXPECT_EQ(with_input({"grow", "-", "-o", path("grown")}, json).status, 0);
  EXPECT_THAT(listing("grown"), ElementsAre("voxel-7-0.json", "voxel-7-1.json"));
}

TEST_F(Inputs, SamplesHaveNames) {
  EXPECT_THAT(names_in(mercury(run_json({"sample:squid", path("r/0.JSON"), "sample:kite"}))),
              ElementsAre("squid", "voxel-7-0", "kite"));
  EXPECT_EQ(mercury({"mutate", "sample:squid", "-o", path("child.json")}).status, 0);
  EXPECT_EQ(mercury({"evolve", path("run"), "--from", "sample:squid", "--dry-run"}).status, 0);
  write("a.toml", "format = \"mercury-scene\"\nversion = 1\nrobots = [\"sample:eel\"]\n");
  EXPECT_THAT(names_in(mercury(run_json({path("a.toml")}))), ElementsAre("eel"));
  for (const Arguments& command :
       {std::vector<std::string>{"run", "sample:ell"}, {"info", "sample:ell"}, {"view", "sample:ell"}}) {
    const Outcome unknown = mercury(command);
    EXPECT_EQ(unknown.status, 2);
    EXPECT_THAT(unknown.messages, StartsWith("mercury: sample:ell: there is no such sample; give "));
    EXPECT_THAT(unknown.messages, testing::HasSubstr(" paper/beetle, paper/boulder, "));
    EXPECT_THAT(unknown.messages, testing::EndsWith(" or paper/wriggler; did you mean eel?\n"));
  }
}

TEST_F(Inputs, DrawingSaysHowMuchAddressSpaceItNeeds) {
  EXPECT_THAT(limited(400'000, "render --random voxel --still 0 --gl osmesa --quiet -o " + path("a.png")),
              Ends(1, HasSubstr("needs 1024 MiB of address space, the limit is 390 MiB (ulimit -v)")));
  EXPECT_FALSE(std::filesystem::exists(path("a.png")));
  EXPECT_THAT(limited(400'000, "view --random voxel --quiet"),
              Ends(1, "drawing on the processor needs 1024 MiB of address space, the limit is 390 MiB (ulimit -v)"));
}

// Mesa ends by SIGSEGV where threads leave it too little.
TEST_F(Inputs, DrawingSaysHowMuchDataItNeeds) {
  for (const int megabytes : {60, 130, 170, 190}) {
    EXPECT_THAT(limited("-d " + std::to_string(megabytes * 1000),
                        "render --random voxel --still 0 --gl osmesa --quiet -o " + path("a.png")),
                Ends(1, testing::MatchesRegex("drawing on the processor needs [0-9]+ MiB of data and stacks, the "
                                              "limit is [0-9]+ MiB \\(ulimit -d\\)")));
  }
}

TEST_F(Inputs, AProgramWithoutMemorySaysWhatTheLimitIs) {
  std::string faces;
  for (int i = 0; i < 2'000'000; ++i) faces += "[0,1,2],";
  write("large.json", R"({"format": "mercury-robot", "version": 1, "masses": [[0,0,0], [1,0,0], [0,1,0]],)"
                      R"("springs": [[0,1,1]], "faces": [)" +
                          faces + "[0,1,2]]}");
  EXPECT_THAT(limited("-d 32768", "info " + path("large.json")),
              Ends(1, "not enough memory: more is needed than the limit, 32 MiB (ulimit -d)"));
  const Outcome threads =
      limited("-s 16384 && ulimit -d 24576", "run --random voxel --seconds 0.01 --device cpu --threads 8");
  EXPECT_EQ(threads.status, 1);
  // If the first thread had begun before the second one failed, TBB warns of that first.
  EXPECT_THAT(threads.messages,
              testing::EndsWith("mercury: no thread could be started: each needs 16384 KiB of stack (ulimit -s), the "
                                "limit is 24 MiB (ulimit -d); give more, or fewer --threads\n"));
}

TEST_F(Inputs, TheProgramSaysHowMuchStackItNeeds) {
  const std::string png = path("a.png"), run = path("run"), robots = path("new");
  for (const std::string& command : {"render --random voxel --still 0 --gl mesa --quiet -o " + png,
                                     std::string("run --random voxel:2 --random nn:2 --seconds 0.01 --quiet"),
                                     "new nn --count 2 --quiet -o " + robots,
                                     "evolve " + run + " --population 4 --generations 1 --seconds 0.01 --quiet"}) {
    for (const std::string kilobytes : {"64", "128"}) {
      EXPECT_THAT(limited("-s " + kilobytes, command),
                  Ends(1, "the program needs 256 KiB of stack, the limit is " + kilobytes + " KiB (ulimit -s)"))
          << command;
    }
    EXPECT_THAT(listing(), testing::Not(testing::Contains(testing::AnyOf("a.png", "run", "new"))));
    EXPECT_EQ(limited("-s 256", command).status, 0) << command;
    for (const std::string& output : {png, run, robots}) std::filesystem::remove_all(output);
  }
}

// The limit counts the processes of a user, and not for the superuser: the program becomes a user who has none.
TEST_F(Inputs, DrawingSaysHowManyThreadsItNeeds) {
  const std::string program = path("mercury");
  std::filesystem::copy_file(MERCURY_PROGRAM, program);
  std::filesystem::permissions(folder_, std::filesystem::perms::all);
  const std::string another = std::to_string(1'000'000 + getpid());
  const std::string as_another = geteuid() == 0 ? "exec setpriv --reuid " + another + " --clear-groups " : "exec ";
  const Outcome outcome =
      run_program("/bin/bash", {"-c", "ulimit -u 3; " + as_another + program +
                                          " render --random voxel --still 0 --gl mesa --quiet -o " + path("a.png")});
  EXPECT_EQ(outcome.status, 1);
  EXPECT_THAT(outcome.messages, HasSubstr("could be started: the "));
  EXPECT_EQ(std::ranges::count(outcome.messages, '\n'), 1) << outcome.messages;
}

TEST_F(Inputs, BadFilesAreLeftOutWithKeepGoing) {
  write("r/1.JSON", "{}");
  const std::string bad = path("r/1.JSON");
  for (const Arguments& command : {run({path("r")}),
                                   {"info", path("r")},
                                   {"grow", path("r"), "-o", path("grown")},
                                   {"mutate", path("r"), "-o", path("mutants")},
                                   {"evolve", path("run"), "--from", path("r"), "--population", "4", "--generations",
                                    "1", "--seconds", "0.01", "--device", "cpu"}}) {
    EXPECT_THAT(mercury(command), Ends(2, StartsWith(bad + ": "))) << command[0];
    EXPECT_THAT(mercury(joined(command, {"--keep-going"})), Ends(1, HasSubstr("left out: " + bad + ": ")))
        << command[0];
  }
  EXPECT_THAT(listing("grown"), ElementsAre("voxel-7-0.json"));
  const Outcome none = mercury(run({bad, "--keep-going"}));
  EXPECT_EQ(none.status, 2);
  EXPECT_THAT(none.messages, HasSubstr("mercury: no robot is left"));
}

TEST_F(Inputs, PipesAreRefusedWithoutWaiting) {
  for (const char* name : {"p.json", "p.h5", "p.repro"}) {
    ASSERT_EQ(::mkfifo(path(name).c_str(), 0600), 0);
    for (const char* command : {"info", "run"}) {
      EXPECT_THAT(mercury({command, path(name)}), Ends(2, StartsWith(path(name) + ": "))) << command << name;
    }
  }
  const Outcome render = mercury({"render", path("p.h5"), "-o", path("a.png"), "--still", "0"});
  EXPECT_EQ(render.status, 2);
  EXPECT_THAT(render.messages, StartsWith("mercury: " + path("p.h5") + ": "));
  EXPECT_THAT(render.messages, HasSubstr("not a regular file"));
}

TEST_F(Inputs, NumbersOfThreadsThatMakeNoSenseAreRefused) {
  succeeded(mercury(run({path("r"), "--record", path("r.h5")})));
  for (const std::string command : {"run", "bench", "verify"})
    for (const char* threads : {"2147483647", "100000", "-1"}) {
      std::vector<std::string> arguments{command, "--threads", threads, "--device", "cpu"};
      if (command == "run") arguments.push_back(path("r"));
      if (command == "verify") arguments.push_back(path("r.h5"));
      EXPECT_THAT(mercury(arguments),
                  Ends(2, StartsWith("--threads: " + std::string(threads) + " is not accepted; give 0")))
          << command;
    }
  write("t.toml", "threads = 100000\n");
  EXPECT_THAT(mercury(run({path("r"), "--config", path("t.toml")})),
              Ends(2, HasSubstr("threads: 100000 is not accepted; give 0")));
}

#ifndef MERCURY_SANITIZED  // sanitizers map more address space than any limit leaves
TEST_F(Inputs, RobotsThatDoNotFitIntoMemoryAreRefused) {
  for (const std::string command : {"run --record r.h5", "render -o a.png --still 0"}) {
    EXPECT_THAT(limited(4'000'000, command + " --device cpu --random voxel:200000"),
                Ends(2, testing::MatchesRegex("--random: about [0-9.]+ GB of memory are needed, "
                                              "[0-9.]+ .B can be used; give up to [0-9]+ robots")))
        << command;
  }
  EXPECT_EQ(limited(4'000'000, "bench --device cpu --count 100000").status, 2);
}

TEST_F(Inputs, ASweepStopsBeforeTheMemoryIsFull) {
  const Outcome outcome =
      limited(400'000, "bench --sweep --device cpu --threads 2 --least-seconds 0.001 --csv " + path("s.csv"));
  EXPECT_EQ(outcome.status, 0) << outcome.messages;
  EXPECT_THAT(outcome.messages, HasSubstr("the sweep stops before "));
  EXPECT_THAT(read("s.csv"), StartsWith("device,"));
  EXPECT_EQ(outcome.output, read("s.csv"));
}

// Whatever is short, the program ends with one line and no signal.
TEST_F(Inputs, NetworksGrowOrNotInLittleMemory) {
  for (long kilobytes = 150'000; kilobytes <= 600'000; kilobytes += 50'000) {
    const Outcome outcome = limited(kilobytes, "new nn --points 4096 --force -o " + path("a.json"));
    EXPECT_THAT(outcome.status, testing::AnyOf(0, 1, 127)) << kilobytes << ": " << outcome.messages;
  }
}
#endif

// Rows are in the file as they are measured; Ctrl-C keeps them.
TEST_F(Inputs, ASweepThatIsStoppedKeepsItsRows) {
  ChildProcess child(MERCURY_PROGRAM, {"bench", "--sweep", "--device", "cpu", "--size", "3x3x3", "--least-seconds",
                                       "0.2", "--csv", path("s.csv")});
  while (!std::filesystem::exists(path("s.csv")) && child.running()) {
  }
  child.signal(SIGINT);
  const Outcome outcome = outcome_of(child);
  EXPECT_EQ(outcome.status, 128 + SIGINT) << outcome.messages;
  EXPECT_EQ(outcome.output, read("s.csv"));
  EXPECT_GE(std::ranges::count(outcome.output, '\n'), 2);
}

}  // namespace
}  // namespace mercury::test
