// SPDX-License-Identifier: Apache-2.0
// Invalid input gives one line and exit status 2; help, version and TOML files.
#include <gmock/gmock.h>
#include <sys/stat.h>

#include "tests/app/program.h"

namespace mercury::test {
namespace {

using testing::HasSubstr;
using testing::StartsWith;

struct BadInput {
  std::string name;
  std::vector<std::string> arguments;
  std::string message;  // after "mercury: "
};

void PrintTo(const BadInput& input, std::ostream* out) { *out << input.name; }

class BadInputTest : public testing::TestWithParam<BadInput> {};

TEST_P(BadInputTest, IsReportedInOneLineWithStatus2) {
  EXPECT_THAT(mercury(GetParam().arguments), Ends(2, GetParam().message));
}

const std::vector<std::string> one{"run", "--random", "voxel:1", "--seconds", "0.01"};

std::vector<std::string> with(const Arguments& more) { return joined(one, more); }

INSTANTIATE_TEST_SUITE_P(
    CommandLine, BadInputTest,
    testing::Values(
        BadInput{"NoCommand", {}, "no command given; see mercury --help"},
        BadInput{"UnknownCommand", {"rendr"}, "\"rendr\" is not a command; did you mean render?; see mercury --help"},
        BadInput{"UnknownCommandToExplain",
                 {"help", "rendr"},
                 "\"rendr\" is not a command; did you mean render?; see mercury --help"},
        BadInput{"UnknownOptionBeforeTheCommand",
                 {"--secnds", "2", "run"},
                 "--secnds: not an option; did you mean --seconds?; see mercury --help"},
        BadInput{"OptionsWithoutCommand", {"--seconds", "2", "-q"}, "no command given; see mercury --help"},
        BadInput{"SwitchWithValue", with({"--json=3"}), "--json: is a switch; give it without a value"},
        BadInput{"NewWithoutKind", {"new"}, "no command given; see mercury new --help"},
        BadInput{"UnknownOption", with({"--secnds", "2"}),
                 "--secnds: not an option of mercury run; did you mean --seconds?; see mercury run --help"},
        BadInput{"NoValue", with({"--dt"}), "--dt: needs a value; see mercury run --help"},
        BadInput{"NoRobots",
                 {"run"},
                 "no robots given; name files, folders or samples (sample:eel), or use --random voxel:12, nn:12, "
                 "shell:12, cppn:12 or tapered:12"},
        BadInput{"UnknownKind",
                 {"run", "--random", "fish:2"},
                 "--random: \"fish\" is not a kind of robot; give voxel:N, nn:N, shell:N, cppn:N or tapered:N"},
        BadInput{"NoCount",
                 {"run", "--random", "voxel:0"},
                 "--random: \"voxel:0\" is not accepted; give 1 to 1000000 robots"},
        BadInput{"NoFile", {"run", "nothing.json"}, "nothing.json: No such file or directory"},
        BadInput{"NoFolder", {"run", "my-robots"}, "my-robots: No such file or directory"}),
    [](const auto& tested) { return tested.param.name; });

INSTANTIATE_TEST_SUITE_P(
    Parameters, BadInputTest,
    testing::Values(
        BadInput{"ZeroStep", with({"--dt", "0"}), "--dt: 0 is not accepted; give a finite number > 0 s"},
        BadInput{"StepNotANumber", with({"--dt", "nan"}), "--dt: nan is not accepted; give a finite number > 0 s"},
        BadInput{"StepIsText", with({"--dt", "fast"}), "--dt: \"fast\" is not accepted; give a number"},
        BadInput{"HalfANumber", with({"--dt", "1e-3s"}), "--dt: \"1e-3s\" is not accepted; give a number"},
        BadInput{"NegativeTime", with({"--seconds", "-1"}),
                 "--seconds: -1 is not accepted; give a finite number >= 0 s"},
        BadInput{"EndlessTime", with({"--seconds", "inf"}),
                 "--seconds: inf is not accepted; give a finite number >= 0 s"},
        BadInput{"NegativeDensity", with({"--density", "-1"}),
                 "--density: -1 is not accepted; give a finite number >= 0 kg/m3"},
        BadInput{"DensityBeyondFloat", with({"--density", "1e99"}),
                 "--density: \"1e99\" is out of range; give a number"},
        BadInput{"FlowOfTwo", with({"--flow", "1,2"}),
                 "--flow: \"1,2\" is not accepted; give three numbers, as in 0.1,0,-2"},
        BadInput{"DensityOnLand", with({"--environment", "land", "--density", "3"}),
                 "--density: land has no such parameter; it applies to ocean and water"},
        BadInput{"FlowOnLand", with({"--environment", "land", "--flow", "1,0,0"}),
                 "--flow: land has no such parameter; it applies to ocean, ocean-simple and water"},
        BadInput{"SelfCollisionInWater", with({"--no-self-collision"}),
                 "--no-self-collision: ocean has no such parameter; it applies to land and water"},
        BadInput{"UnknownEnvironment", with({"--environment", "moon"}),
                 "--environment: \"moon\" is not an environment; give ocean, ocean-simple, land or water"},
        BadInput{"UnknownSolver", with({"--solver", "euler"}),
                 "--solver: \"euler\" is not a solver; give force or xpbd"},
        BadInput{"UnknownDevice", with({"--device", "tpu"}),
                 "--device: \"tpu\" is not a device; give auto, cpu, cuda, cuda:N or cuda:all; did you mean cpu?"},
        BadInput{"NegativeThreads", with({"--threads", "-1"}), "--threads: -1 is not accepted; give 0 or more"},
        BadInput{"NegativeSeed", with({"--seed", "-1"}),
                 "--seed: \"-1\" is not accepted; give a whole number of 0 or more"},
        BadInput{"AllAir", with({"--air", "1"}), "--air: 1 is not accepted; give at least 0 and below 1"},
        BadInput{"FlatVoxels", with({"--voxels", "3x3x0"}),
                 "--voxels: \"3x3x0\" is not accepted; give XxYxZ, or a range as in 4x3x3..7x5x4, in whole numbers "
                 "above 0"}),
    [](const auto& tested) { return tested.param.name; });

// A variable that a script did not set.
INSTANTIATE_TEST_SUITE_P(
    EmptyValues, BadInputTest,
    testing::Values(
        BadInput{"Csv", with({"--csv", ""}),
                 "--csv: an empty value is not accepted; give FILE, or leave the option out"},
        BadInput{"CsvWithEqualsSign", with({"--csv="}),
                 "--csv: an empty value is not accepted; give FILE, or leave the option out"},
        BadInput{"Record", with({"--record", ""}),
                 "--record: an empty value is not accepted; give FILE.h5, or leave the option out"},
        BadInput{"Config", with({"--config", ""}),
                 "--config: an empty value is not accepted; give FILE.toml, or leave the option out"},
        BadInput{"Output",
                 {"new", "voxel", "-o", ""},
                 "-o: an empty value is not accepted; give FILE|FOLDER, or leave the option out"},
        BadInput{"Robots", {"run", ""}, "ROBOTS: an empty value is not accepted; give PATH, or leave it out"},
        BadInput{"Run", {"evolve", ""}, "RUN: an empty value is not accepted; give FOLDER, or leave it out"},
        BadInput{"Name",
                 {"mutate", "a.json", "-o", "b.json", "--name", ""},
                 "--name: an empty value is not accepted; give NAME, or leave the option out"},
        BadInput{"Number", with({"--dt", ""}), "--dt: \"\" is not accepted; give a number"}),
    [](const auto& tested) { return tested.param.name; });

INSTANTIATE_TEST_SUITE_P(
    MistypedValues, BadInputTest,
    testing::Values(
        BadInput{"Solver", with({"--solver", "xpdb"}),
                 "--solver: \"xpdb\" is not a solver; give force or xpbd; did you mean xpbd?"},
        BadInput{"Environment", with({"--environment", "ocan"}),
                 "--environment: \"ocan\" is not an environment; give ocean, ocean-simple, land or water; did you mean "
                 "ocean?"},
        BadInput{"Device", with({"--device", "cuad:1"}),
                 "--device: \"cuad:1\" is not a device; give auto, cpu, cuda, cuda:N or cuda:all; did you mean cuda?"},
        BadInput{"Kind",
                 {"run", "--random", "vxel:3"},
                 "--random: \"vxel\" is not a kind of robot; give voxel:N, nn:N, shell:N, cppn:N or tapered:N; did you "
                 "mean voxel?"},
        BadInput{"Word", with({"--form", "ribg"}),
                 "--form: \"ribg\" is not accepted; give any, bell, tube, ring or pod; did you mean ring?"},
        BadInput{
            "Shown",
            {"render", "--random", "voxel", "-o", "a.mp4", "--show", "skin,sprngs"},
            "--show: \"sprngs\" is not accepted; give some of "
            "skin,springs,masses,drag,lift,velocity,gravity,contact,force,path,labels,captions,legend,clock,scale; did "
            "you mean springs?"},
        BadInput{
            "Camera",
            {"render", "--random", "voxel", "-o", "a.mp4", "--camera", "turntabel"},
            "--camera: \"turntabel\" is not accepted; give group, follow, turntable, top, still, follow:ROBOT or a "
            "camera file (.json); did you mean turntable?"},
        BadInput{"Theme",
                 {"render", "--random", "voxel", "-o", "a.mp4", "--theme", "drak"},
                 "--theme: \"drak\" is not accepted; give dark, light; did you mean dark?"},
        BadInput{"Color",
                 {"render", "--random", "voxel", "-o", "a.mp4", "--color", "strian"},
                 "--color: \"strian\" is not accepted; give material, activation, strain, force, speed, pressure, "
                 "energy, stiffness, power; did you mean strain?"}),
    [](const auto& tested) { return tested.param.name; });

INSTANTIATE_TEST_SUITE_P(
    Pictures, BadInputTest,
    testing::Values(
        BadInput{"UnknownExtension",
                 {"render", "--random", "voxel", "-o", "a.avi"},
                 "-o: a.avi: \".avi\" is not a format written here; give .mp4, .webm, .gif, .apng, or a folder for PNG "
                 "pictures"},
        BadInput{"SizeIsText",
                 {"render", "--random", "voxel", "-o", "a.mp4", "--size", "big"},
                 "--size: \"big\" is not accepted; give WIDTHxHEIGHT, 720p, 1080p or 4k in whole numbers above 0"},
        BadInput{"HugeSize",
                 {"render", "--random", "voxel", "-o", "a.mp4", "--size", "100000x4"},
                 "--size: 100000x4 is not accepted; give WIDTHxHEIGHT from 1x1 to 16384x16384"},
        BadInput{"NoFrames",
                 {"render", "--random", "voxel", "-o", "a.mp4", "--fps", "0"},
                 "--fps: 0 is not accepted; give a finite number > 0 frames/s"},
        BadInput{"FastGif",
                 {"render", "--random", "voxel", "-o", "a.gif", "--fps", "60"},
                 "--fps: a GIF shows at most 50 frames/s; give 50 or less, or another format"},
        BadInput{"NoSpeed",
                 {"render", "--random", "voxel", "-o", "a.mp4", "--speed", "-2"},
                 "--speed: -2 is not accepted; give 1e-06 to 1000000"},
        BadInput{"PictureOfNoMoment",
                 {"render", "--random", "voxel", "-o", "a.png"},
                 "-o: a.png is one picture; add --still SECONDS or --contact-sheet 5x2, or give a folder"},
        BadInput{"StillIntoAVideo",
                 {"render", "--random", "voxel", "-o", "a.mp4", "--still", "1"},
                 "-o: a.mp4: a picture is written as .png; give such a name"},
        BadInput{"TinyMoments",
                 {"render", "--random", "voxel", "-o", "a.png", "--contact-sheet", "500x2"},
                 "--contact-sheet: the moments are too small to be drawn; give a larger --size or fewer moments"},
        BadInput{"GridTooSmall",
                 {"render", "--random", "voxel:5", "-o", "a.png", "--still", "0", "--grid", "2x2"},
                 "--grid: 5 robots do not fit into 2x2; give more columns or rows"},
        BadInput{"UnknownColor",
                 {"render", "--random", "voxel", "-o", "a.mp4", "--color", "mood"},
                 "--color: \"mood\" is not accepted; give material, activation, strain, force, speed, pressure, "
                 "energy, stiffness, power"},
        BadInput{"PressureOnLand",
                 {"render", "--random", "voxel", "-o", "a.png", "--still", "0", "--color", "pressure", "--environment",
                  "land"},
                 "--color: pressure: land has no drag on faces; it applies to ocean, water"},
        BadInput{"ScaleUpsideDown",
                 {"render", "--random", "voxel", "-o", "a.mp4", "--scale", "2,1"},
                 "--scale: \"2,1\" is not accepted; give two finite numbers, the lower first"},
        BadInput{
            "UnknownThing",
            {"render", "--random", "voxel", "-o", "a.mp4", "--show", "skin,bones"},
            "--show: \"bones\" is not accepted; give some of "
            "skin,springs,masses,drag,lift,velocity,gravity,contact,force,path,labels,captions,legend,clock,scale"},
        BadInput{
            "UnknownCamera",
            {"render", "--random", "voxel", "-o", "a.mp4", "--camera", "drone"},
            "--camera: \"drone\" is not accepted; give group, follow, turntable, top, still, follow:ROBOT or a camera "
            "file (.json)"},
        BadInput{"NobodyToFollow",
                 {"render", "--random", "voxel", "-o", "a.png", "--still", "0", "--camera", "follow:eel"},
                 "--camera: no robot is named \"eel\"; give a name, or a number from 0 to 0"},
        BadInput{"UnknownGl",
                 {"render", "--random", "voxel", "-o", "a.mp4", "--gl", "vulkan"},
                 "--gl: \"vulkan\" is not accepted; give auto, egl, mesa, osmesa"}),
    [](const auto& tested) { return tested.param.name; });

TEST(Program, PrintsItsVersion) {
  for (const Arguments& arguments :
       std::vector<std::vector<std::string>>{{"--version"}, {"-V"}, {"run", "-V"}, {"-V", "new", "voxel"}}) {
    const Outcome outcome = succeeded(mercury(arguments));
    EXPECT_THAT(outcome.output, StartsWith("mercury "));
  }
}

TEST(Program, HelpNamesEveryCommandAndGoesToStandardOutput) {
  const Outcome outcome = succeeded(mercury({"--help"}));
  EXPECT_EQ(outcome.messages, "");
  for (const char* command : {"render", "run", "new", "info"}) EXPECT_THAT(outcome.output, HasSubstr(command));
}

TEST(Program, EachCommandHasItsOwnHelp) {
  EXPECT_THAT(mercury({"render", "--help"}).output, HasSubstr("--fps"));
  EXPECT_THAT(mercury({"new", "voxel", "--help"}).output, HasSubstr("--symmetry"));
}

TEST(Program, HelpExplainsACommandLikeItsOption) {
  EXPECT_EQ(mercury({"help"}).output, mercury({"--help"}).output);
  EXPECT_EQ(mercury({"help", "run"}).output, mercury({"run", "--help"}).output);
  EXPECT_EQ(mercury({"help", "new", "voxel"}).output, mercury({"new", "--help", "voxel"}).output);
  EXPECT_EQ(mercury({"help", "run"}).status, 0);
}

TEST(Program, ShortHelpLeavesOutWhatFewNeed) {
  const std::string brief = mercury({"run", "-h"}).output, all = mercury({"run", "--help"}).output;
  EXPECT_LT(brief.size(), all.size());
  EXPECT_THAT(brief, HasSubstr("--csv"));
  EXPECT_THAT(brief, testing::Not(HasSubstr("--canvas-symmetry")));
  EXPECT_THAT(all, HasSubstr("--canvas-symmetry"));
}

// Errors of a command with --json are for programs. They are on standard error, where they mix with no result.
TEST(Program, ErrorsAreJsonWithJson) {
  const auto error_of = [](const Arguments& arguments) {
    const Outcome outcome = mercury(arguments);
    EXPECT_EQ(outcome.output, "");
    EXPECT_EQ(std::ranges::count(outcome.messages, '\n'), 1) << outcome.messages;
    const auto json = nlohmann::json::parse(outcome.messages, nullptr, false);
    EXPECT_EQ(json["error"]["exit"], outcome.status);
    return json["error"]["message"].get<std::string>();
  };
  const std::string strange = std::string("a\n\"\xff") + ".json";
  EXPECT_EQ(error_of({"run", "none.json", "--json"}), "none.json: No such file or directory");
  EXPECT_EQ(error_of({"info", strange, "--json"}), R"(a\n"\xff.json: No such file or directory)");
  EXPECT_EQ(error_of({"verify", "none.h5", "--json", "--threads", "x"}),
            "--threads: \"x\" is not accepted; give a whole number");
  EXPECT_EQ(error_of({"run", "--json", "--dt", "0", "--random", "voxel"}),
            "--dt: 0 is not accepted; give a finite number > 0 s");
  EXPECT_EQ(error_of({"run", "--json", "--secnds", "2"}),
            "--secnds: not an option of mercury run; did you mean --seconds?; see mercury run --help");
  EXPECT_EQ(error_of({"--json"}), "no command given; see mercury --help");
}

// Only examples, and names of options with long forms, may be wider than the terminal.
TEST(Program, HelpFitsTheTerminal) {
  for (const int columns : {50, 80}) {
    setenv("COLUMNS", std::to_string(columns).c_str(), 1);
    for (const char* command : {"run", "render", "evolve", "info"}) {
      std::istringstream lines(mercury({command, "--help"}).output);
      for (std::string line; std::getline(lines, line);)
        if (!line.starts_with("  mercury ") && !line.starts_with("  mpirun ") && !line.starts_with("  -")) {
          EXPECT_LE(line.size(), static_cast<std::size_t>(columns)) << line;
        }
    }
  }
  unsetenv("COLUMNS");
}

TEST(Program, OptionsMayStandBeforeTheCommand) {
  const std::vector<std::string> usual{"run", "--random", "voxel:2", "--seed", "4", "--seconds", "0.01", "--csv", "-"};
  const Outcome expected = succeeded(mercury(usual));
  for (const Arguments& arguments : std::vector<std::vector<std::string>>{
           {"--seconds", "0.01", "run", "--random", "voxel:2", "--seed", "4", "--csv", "-"},
           {"--random", "voxel:2", "--seed=4", "-q", "--seconds", "0.01", "--csv", "-", "run"}})
    EXPECT_EQ(mercury(arguments).output, expected.output);
}

TEST(Program, QuietAndVerboseStandAnywhere) {
  const std::vector<std::string> with_note{"--random", "voxel", "--seconds", "0.01"};
  for (const bool before : {false, true}) {
    std::vector<std::string> arguments = with_note;
    arguments.insert(arguments.begin(), before ? std::initializer_list<std::string>{"-v", "run"}
                                               : std::initializer_list<std::string>{"run", "-v"});
    EXPECT_THAT(mercury(arguments).messages, HasSubstr("of memory")) << before;
    for (std::string& argument : arguments)
      if (argument == "-v") argument = "-q";
    EXPECT_EQ(mercury(arguments).messages, "") << before;
  }
}

TEST(Program, OutputThatCannotBeWrittenIsAnError) {
  const Outcome outcome =
      run_program("sh", {"-c", std::string(MERCURY_PROGRAM) + " run --random voxel --seconds 0.01 >/dev/full"});
  EXPECT_EQ(outcome.status, 1);
  EXPECT_EQ(outcome.messages, "mercury: standard output cannot be written: the disk is full\n");
}

class ConfigFileTest : public FolderTest {
 protected:
  Outcome run_with(const std::string& toml, const Arguments& more = {}, bool json = true) {
    write("a.toml", toml);
    std::vector<std::string> arguments{"run", "--random", "voxel", "--seconds", "0.01", "--config", path("a.toml")};
    if (json) arguments.emplace_back("--json");
    return mercury(joined(arguments, more));
  }
  nlohmann::json configuration_with(const std::string& toml, const Arguments& more = {}) {
    return nlohmann::json::parse(run_with(toml, more).output, nullptr, false)["configuration"];
  }
};

TEST_F(ConfigFileTest, SetsOptions) {
  const auto configuration = configuration_with(
      "dt = 0.002\nsolver = \"xpbd\"\nflow = [0.5, 0, -1]\n[run]\ndensity = 900\n[render]\nfps = 3\n");
  EXPECT_EQ(configuration["dt"], 0.002);
  EXPECT_EQ(configuration["solver"], "xpbd");
  EXPECT_EQ(configuration["flow"], nlohmann::json({0.5, 0.0, -1.0}));
  EXPECT_EQ(configuration["density"], 900.0);
}

TEST_F(ConfigFileTest, CommandLineOverridesTheFileAndItsTableOverridesItsTop) {
  const std::string toml = "dt = 0.002\ndamping = 1\n[run]\ndamping = 2\n";
  const auto configuration = configuration_with(toml, {"--dt", "0.004"});
  EXPECT_EQ(configuration["dt"], 0.004);
  EXPECT_EQ(configuration["damping"], 2.0);
}

TEST_F(ConfigFileTest, SwitchesAreTrueOrFalse) {
  EXPECT_EQ(configuration_with("environment = \"land\"\nno-self-collision = true\n")["self_collision"], false);
  EXPECT_EQ(configuration_with("environment = \"land\"\nno-self-collision = false\n")["self_collision"], true);
}

TEST_F(ConfigFileTest, ErrorsNameFileLineAndOption) {
  const std::string file = path("a.toml");
  const auto expect_error = [&](const std::string& toml, const std::string& message) {
    EXPECT_THAT(run_with(toml, {}, false), Ends(2, file + message)) << toml;
  };
  expect_error("dt = 0.002\ndensity = -5\n", ":2: --density: -5 is not accepted; give a finite number >= 0 kg/m3");
  expect_error("\n\nsolver = \"euler\"\n", ":3: --solver: \"euler\" is not a solver; give force or xpbd");
  expect_error("speeed = 3\n",
               ":1: \"speeed\" is not an option of mercury; did you mean speed?; see mercury run --help");
  expect_error("[walk]\nspeed = 3\n", ":1: [walk] is not a command of mercury");
  expect_error("strict = 3\n", ":1: --strict is a switch; give true or false");
  expect_error("dt = true\n", ":1: --dt is not a switch; give a value");
  expect_error("environment = \"land\"\ndensity = 3\n",
               ":2: --density: land has no such parameter; it applies to ocean and water");
}

// A typo is reported even where the current command would not read it.
TEST_F(ConfigFileTest, TyposInTablesOfOtherCommandsAreReported) {
  const std::string file = path("a.toml");
  const auto expect_error = [&](const std::string& toml, const std::string& message) {
    EXPECT_THAT(run_with(toml, {}, false), Ends(2, file + message)) << toml;
  };
  expect_error("[new.voxl]\nair = 0.2\n", ":1: [voxl] is not a command of mercury new; did you mean voxel?");
  expect_error("[new.voxel]\nedge = 0.2\nair = 0.3\nsymetry = \"x\"\n",
               ":4: \"symetry\" is not an option of mercury new voxel; did you mean symmetry?; see mercury new voxel "
               "--help");
  expect_error("[render]\nfsp = 25\n",
               ":2: \"fsp\" is not an option of mercury render; did you mean fps?; see mercury render --help");
  expect_error("[new.nn]\nair = 0.2\n", ":2: \"air\" is not an option of mercury new nn; see mercury new nn --help");
  expect_error("solver = \"xpdb\"\n", ":1: --solver: \"xpdb\" is not a solver; give force or xpbd; did you mean xpbd?");
  expect_error("csv = \"\"\n", ":1: --csv: an empty value is not accepted; give FILE, or leave the option out");
}

// Each table overrides the keys above it: [new.voxel] those of [new], and those those at the top.
TEST_F(ConfigFileTest, TablesOfKindsOverrideThoseOfTheirCommand) {
  write("a.toml", "seed = 3\n[new]\nseed = 4\ncount = 2\n[new.voxel]\nseed = 5\nvoxels = \"2x2x2\"\n");
  succeeded(mercury({"new", "voxel", "-o", path("v"), "--config", path("a.toml")}));
  EXPECT_EQ(listing("v"), (std::vector<std::string>{"voxel-5-0.json", "voxel-5-1.json"}));
  succeeded(mercury({"new", "shell", "-o", path("s"), "--config", path("a.toml")}));
  EXPECT_EQ(listing("s"), (std::vector<std::string>{"shell-4-0.json", "shell-4-1.json"}));
}

// Opening a pipe without a writer would wait for ever.
TEST_F(ConfigFileTest, MustBeARegularFile) {
  ASSERT_EQ(mkfifo(path("pipe").c_str(), 0600), 0);
  for (const std::string& file : {path("pipe"), folder_.string(), std::string("/dev/zero")}) {
    EXPECT_THAT(mercury({"run", "--random", "voxel", "--config", file}),
                Ends(2, "--config: " + file + " is not a file; give a TOML file"));
  }
}

TEST_F(ConfigFileTest, InvalidTomlIsReportedWithItsLine) {
  EXPECT_THAT(run_with("dt = 0.001\nthis is no toml\n", {}, false), Ends(2, StartsWith(path("a.toml") + ":2: ")));
}

TEST_F(ConfigFileTest, FileMustExist) {
  EXPECT_THAT(mercury({"run", "--random", "voxel", "--config", path("none.toml")}),
              Ends(2, "--config: " + path("none.toml") + " cannot be read: No such file or directory"));
}

}  // namespace
}  // namespace mercury::test
