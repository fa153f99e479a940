// SPDX-License-Identifier: Apache-2.0
// Every parameter of a simulation can be given on the command line and in a TOML file. A value that cannot be used is
// refused in one line that names the option.
#include <gmock/gmock.h>

#include "app/options/command.h"
#include "app/options/config_file.h"
#include "mercury/error.h"
#include "mercury/random.h"
#include "tests/app/program.h"

namespace mercury {
AddCommand add_run_command, add_render_command;
}

namespace mercury::test {
namespace {

using nlohmann::json;
using testing::HasSubstr;
using testing::StartsWith;

struct Parameter {
  std::string option;       // without its dashes
  std::string environment;  // one that has it
  std::string word;         // a value that is not the default, on the command line
  std::string toml;         // the same in TOML
  json expected;            // in the report of `run --json`
  std::vector<std::string> bad;
  std::string accepted;  // part of the answer to them
};

void PrintTo(const Parameter& parameter, std::ostream* out) { *out << parameter.option; }

const std::string number = "give a number", at_least_zero = "give a finite number >= 0";

// All parameters that the report of `run --json` contains.
const std::vector<Parameter> parameters{
    {"device",
     "ocean",
     "cpu",
     "\"cpu\"",
     "cpu",
     {"gpu", "cuda:-1", "cuda:x"},
     "give auto, cpu, cuda, cuda:N or cuda:all"},
    {"environment",
     "ocean",
     "ocean-simple",
     "\"ocean-simple\"",
     "ocean-simple",
     {"sea"},
     "give ocean, ocean-simple, land or water"},
    {"solver", "ocean", "xpbd", "\"xpbd\"", "xpbd", {"euler"}, "give force or xpbd"},
    {"dt", "ocean", "0.002", "0.002", 0.002, {"0", "-1", "nan", "inf"}, "give a finite number > 0 s"},
    {"damping", "ocean", "0.5", "0.5", 0.5, {"-1", "nan", "inf"}, at_least_zero + " 1/s"},
    {"density", "ocean", "900", "900", 900.0, {"-1", "nan", "inf"}, at_least_zero + " kg/m3"},
    {"drag-coefficient", "ocean", "1.5", "1.5", 1.5, {"-1", "nan"}, at_least_zero},
    {"lift-coefficient", "ocean", "0.4", "0.4", 0.4, {"-0.1", "nan"}, at_least_zero},
    {"drag-tangential", "ocean", "0.02", "0.02", 0.02, {"-1", "nan"}, at_least_zero},
    {"flow",
     "ocean",
     "0.5,0,-1",
     "[0.5, 0, -1]",
     {0.5, 0.0, -1.0},
     {"nan,0,0", "0,inf,0"},
     "give three finite numbers of m/s"},
    {"flow",
     "ocean-simple",
     "0,2,0",
     "[0, 2, 0]",
     {0.0, 2.0, 0.0},
     {"0,0", "1,2,3,4"},
     "give three numbers, as in 0.1,0,-2"},
    {"point-drag", "ocean-simple", "2.5", "2.5", 2.5, {"-1", "nan"}, at_least_zero + " N s/m"},
    {"gravity",
     "land",
     "0,0.5,-1.62",
     "[0, 0.5, -1.62]",
     {0.0, 0.5, -1.62},
     {"nan", "inf,0,0"},
     "give three finite numbers of m/s2"},
    {"gravity", "ocean", "2", "2", {0.0, 0.0, -2.0}, {"down", "a,b,c"}, number},
    {"friction", "land", "0.3", "0.3", 0.3, {"-1", "nan"}, at_least_zero},
    {"static-friction", "land", "0.9", "0.9", 0.9, {"-1", "nan"}, at_least_zero},
    {"contact-stiffness", "land", "50", "50", 50.0, {"-1", "nan"}, at_least_zero + " N/m"},
    {"stiffness-scale", "land", "100", "100", 100.0, {"-1", "nan"}, at_least_zero},
    {"stiffness-scale", "ocean-simple", "3", "3", 3.0, {"1e99"}, number},
    {"threads", "ocean", "2", "2", 2, {"-1"}, "give 0 or more"},
    {"threads", "land", "1", "1", 1, {"1.5", "two"}, "give a whole number"},
};

class EveryParameter : public FolderTest, public testing::WithParamInterface<Parameter> {
 protected:
  const Parameter& parameter() const { return GetParam(); }
  std::vector<std::string> run_with(const std::vector<std::string>& more) const {
    std::vector<std::string> arguments{"run", "--random", "voxel:1", "--seconds", "0", "--json"};
    if (parameter().option != "environment") arguments.push_back("--environment=" + parameter().environment);
    arguments.insert(arguments.end(), more.begin(), more.end());
    return arguments;
  }
  json value_in(const Outcome& outcome) const {
    std::string name = parameter().option;
    std::replace(name.begin(), name.end(), '-', '_');
    return json::parse(outcome.output, nullptr, false)["configuration"][name];
  }
  // One line that begins with `place` and the option, and says what is accepted.
  void expect_refused(const Outcome& outcome, const std::string& place) const {
    EXPECT_EQ(outcome.status, 2);
    EXPECT_EQ(outcome.output, "");
    const json error = json::parse(outcome.messages, nullptr, false);
    ASSERT_TRUE(error.is_object()) << outcome.messages;
    const std::string message = error["error"]["message"];
    EXPECT_THAT(message, StartsWith(place + "--" + parameter().option + ": "));
    EXPECT_THAT(message, HasSubstr(parameter().accepted));
    EXPECT_EQ(std::count(outcome.messages.begin(), outcome.messages.end(), '\n'), 1) << outcome.messages;
  }
};

TEST_P(EveryParameter, IsTakenFromTheCommandLine) {
  EXPECT_NE(value_in(mercury(run_with({}))), parameter().expected) << "the default would pass for it";
  EXPECT_EQ(value_in(mercury(run_with({"--" + parameter().option + "=" + parameter().word}))), parameter().expected);
}

TEST_P(EveryParameter, IsTakenFromAFile) {
  write("a.toml", parameter().option + " = " + parameter().toml + "\n");
  EXPECT_EQ(value_in(mercury(run_with({"--config", path("a.toml")}))), parameter().expected);
}

TEST_P(EveryParameter, IsRefusedInOneLineWhereItCannotBeUsed) {
  for (const std::string& bad : parameter().bad) {
    SCOPED_TRACE("\"" + bad + "\"");
    expect_refused(mercury(run_with({"--" + parameter().option + "=" + bad})), "");
    write("a.toml", "seed = 1\n" + parameter().option + " = \"" + bad + "\"\n");
    expect_refused(mercury(run_with({"--config", path("a.toml")})), path("a.toml") + ":2: ");
  }
}

TEST_P(EveryParameter, NeedsAValue) {
  const auto expect_asked = [&](const Outcome& outcome) {
    EXPECT_EQ(outcome.status, 2);
    EXPECT_THAT(outcome.messages, HasSubstr("--" + parameter().option + ": an empty value is not accepted; give "));
  };
  expect_asked(mercury(run_with({"--" + parameter().option + "="})));
  write("a.toml", parameter().option + " = \"\"\n");
  expect_asked(mercury(run_with({"--config", path("a.toml")})));
}

INSTANTIATE_TEST_SUITE_P(Design, EveryParameter, testing::ValuesIn(parameters), [](const auto& tested) {
  std::string name = tested.param.option + "_" + tested.param.environment;
  std::replace(name.begin(), name.end(), '-', '_');
  return name;
});

class ConfigFileFuzz : public FolderTest {};

// Parses the file as the program does, but simulates nothing.
void parse_run_with(const std::string& file) {
  const CommandTree tree;
  const Command program = tree.root();
  add_run_command(program, [](CommandBody) {});
  add_render_command(program, [](CommandBody) {});
  const Command run = *program.find_command("run");
  std::vector<std::string> arguments = ConfigFile(file, program, run, {"run"}).arguments();
  arguments.insert(arguments.begin(), "run");
  tree.parse(arguments);
}

TEST_F(ConfigFileFuzz, DamagedFilesAreReadOrRefusedInOneLine) {
  const std::string sound =
      "# a run\ndt = 2e-3\nsolver = \"xpbd\"\nflow = [0.5, 0, -1]\nrandom = [\"voxel:2\", 'voxel:3']\nseed = 7\n"
      "[run]\nstrict = true\ndensity = 1_000.5\ndevice = \"\"\"cpu\"\"\"\ngravity = 0x10\n[render]\nsize = \"64x64\"\n";
  write("a.toml", sound);
  ASSERT_NO_THROW(parse_run_with(path("a.toml")));
  constexpr std::string_view pieces[] = {"[",   "]",  "[[",    "{",          "}",   "=",          "\"",
                                         "\n",  "\0", "nan",   "1979-05-27", "'''", "\\u",        "\xff",
                                         "run", ".",  "1e999", "0b2",        "#",   "a.b.c = 1\n"};
  int read = 0, refused = 0;
  for (std::uint64_t seed = 0; seed < 2000; ++seed) {
    Random random(seed);
    std::string text = sound;
    for (std::uint64_t edits = 1 + random.below(4); edits > 0; --edits) {
      const auto at = static_cast<std::size_t>(random.below(text.size() + 1));
      switch (random.below(4)) {
        case 0:
          text.insert(at, pieces[random.below(std::size(pieces))]);
          break;
        case 1:
          text.erase(at, random.below(12));
          break;
        case 2:
          text.insert(at, text.substr(static_cast<std::size_t>(random.below(text.size() + 1)), random.below(30)));
          break;
        default:
          text.insert(at, 1, static_cast<char>(random.below(256)));
          break;
      }
    }
    write("a.toml", text);
    try {
      parse_run_with(path("a.toml"));
      ++read;
    } catch (const InputError& error) {
      ++refused;
    } catch (const UnknownArgument&) {
      ++refused;  // the program makes a line of it
    } catch (const MissingValue&) {
      ++refused;
    } catch (const ParseFailure&) {
      ++refused;
    }
  }
  EXPECT_GT(read, 40);
  EXPECT_GT(refused, 500);
}

TEST_F(ConfigFileFuzz, HostileFilesAreRefusedInOneLine) {
  const std::string deep(200'000, '['), long_key(200'000, 'k');
  for (const std::string& text :
       {"dt = " + deep, "a" + deep, long_key + " = 1\n", "dt = \"" + long_key + "\"\n",
        "x = " + std::string(100'000, '{'), std::string("dt = 1\0\n", 8), std::string("\xef\xbb\xbf\xfe")}) {
    write("a.toml", text);
    const Outcome outcome = mercury({"run", "--random", "voxel:1", "--seconds", "0", "--config", path("a.toml")});
    EXPECT_EQ(outcome.status, 2) << text.substr(0, 20);
    EXPECT_THAT(outcome.messages, StartsWith("mercury: " + path("a.toml") + ":1"));
    EXPECT_EQ(std::count(outcome.messages.begin(), outcome.messages.end(), '\n'), 1);
    EXPECT_LT(outcome.messages.size(), 1000u) << text.substr(0, 20);
  }
}

TEST_F(ConfigFileFuzz, AFolderIsNoFile) {
  const Outcome outcome = mercury({"run", "--random", "voxel:1", "--seconds", "0", "--config", folder_.string()});
  EXPECT_EQ(outcome.status, 2);
  EXPECT_EQ(outcome.messages, "mercury: --config: " + folder_.string() + " is not a file; give a TOML file\n");
}

}  // namespace
}  // namespace mercury::test
