// SPDX-License-Identifier: Apache-2.0
// Every parameter of a simulation can be given on the command line and in a TOML file. A value that cannot be used is
// refused in one line that names the option.
#include <gmock/gmock.h>

#include "tests/app/program.h"

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
  std::vector<std::string> run_with(const Arguments& more) const {
    std::vector<std::string> arguments{"run", "--random", "voxel:1", "--seconds", "0", "--json"};
    if (parameter().option != "environment") arguments.push_back("--environment=" + parameter().environment);
    return joined(arguments, more);
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

class HostileConfigFile : public FolderTest {};

TEST_F(HostileConfigFile, IsRefusedInOneLine) {
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

TEST_F(HostileConfigFile, MayBeAFolder) {
  EXPECT_THAT(mercury({"run", "--random", "voxel:1", "--seconds", "0", "--config", folder_.string()}),
              Ends(2, "--config: " + folder_.string() + " is not a file; give a TOML file"));
}

}  // namespace
}  // namespace mercury::test
