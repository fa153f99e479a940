// SPDX-License-Identifier: Apache-2.0
// The list of all commands and options that the program prints for other programs.
#include <cstdio>
#include <map>
#include <memory>
#include <set>

#include "tests/app/program.h"

namespace mercury::test {
namespace {

std::string text_of(const nlohmann::json& text) { return text.get<std::string>(); }

std::string command_name(const nlohmann::json& command) {
  std::string name;
  for (const auto& word : command["words"]) name.append(name.empty() ? "" : " ").append(word.get<std::string>());
  return name;
}

bool holds(const nlohmann::json& list, const std::string& word) {
  return std::any_of(list.begin(), list.end(), [&](const auto& own) { return text_of(own) == word; });
}

// The list is longer than what Outcome keeps of an output.
nlohmann::json commands() {
  const std::unique_ptr<FILE, int (*)(FILE*)> pipe(popen(MERCURY_PROGRAM " describe-options json", "r"), pclose);
  return nlohmann::json::parse(pipe.get())["commands"];
}

// The option of a command: of "new voxel".
nlohmann::json option_named(const std::string& of, const std::string& name) {
  for (const auto& command : commands())
    if (command_name(command) == of)
      for (const auto& option : command["options"])
        for (const auto& own : option["names"])
          if (text_of(own) == name) return option;
  return {};
}

// Options in the help of a command: words that begin with a dash, at the beginning of a line or after ", ".
std::set<std::string> options_in_help(const Arguments& words) {
  std::vector<std::string> arguments(words);
  std::istringstream lines(mercury(joined(arguments, {"--help"})).output);
  std::set<std::string> found;
  for (std::string line; std::getline(lines, line);) {
    if (!line.starts_with("  -")) continue;
    std::istringstream parts(line);
    for (std::string part; parts >> part && part.starts_with("-");) {
      for (std::size_t start = 0; start < part.size();) {
        const std::size_t end = std::min(part.find(',', start), part.size());
        found.insert(part.substr(start, end - start));
        start = end + 1;
      }
    }
  }
  return found;
}

TEST(CommandList, HoldsTheOptionsThatTheHelpShows) {
  std::size_t checked = 0;
  for (const auto& command : commands()) {
    std::set<std::string> listed;
    for (const auto& option : command["options"])
      if (!option["positional"])
        for (const auto& name : option["names"]) listed.insert(name.get<std::string>());
    EXPECT_EQ(listed, options_in_help(command["words"].get<std::vector<std::string>>())) << command_name(command);
    checked += listed.size();
  }
  EXPECT_GT(checked, 300u);
}

// -h is one screen; --help has the rest.
TEST(CommandList, ShortHelpOfEveryCommandIsOneScreen) {
  for (const auto& command : commands()) {
    std::vector<std::string> arguments = command["words"].get<std::vector<std::string>>();
    const std::string name = arguments.empty() ? "mercury" : "mercury " + command_name(command);
    const Outcome outcome = mercury(joined(arguments, {"-h"}));
    EXPECT_EQ(outcome.status, 0) << name;
    std::size_t count = 0;
    std::string last;
    std::istringstream lines(outcome.output);
    for (std::string line; std::getline(lines, line); last = line, ++count)
      EXPECT_LE(line.size(), 100u) << name << ": " << line;
    EXPECT_LE(count, 30u) << name;
    EXPECT_EQ(last, name + " --help shows all");
    for (const auto& option : command["options"])
      if (option["required"] || option["positional"]) {
        EXPECT_NE(outcome.output.find(text_of(option["names"][0])), std::string::npos) << name << option["names"];
      }
  }
}

// Options may stand before the command, where it is not known yet which command they belong to.
TEST(CommandList, AnOptionTakesAValueInAllCommandsOrInNone) {
  std::map<std::string, bool> takes_value;
  for (const auto& command : commands())
    for (const auto& option : command["options"])
      for (const auto& name : option["names"]) {
        const bool takes = text_of(option["kind"]) != "switch";
        const auto known = takes_value.emplace(name.get<std::string>(), takes).first;
        EXPECT_EQ(known->second, takes) << command_name(command) << " " << name;
      }
}

TEST(CommandList, KnowsWhatAValueIs) {
  EXPECT_EQ(text_of(option_named("run", "--dt")["kind"]), "number");
  EXPECT_EQ(text_of(option_named("run", "--threads")["kind"]), "whole number");
  EXPECT_EQ(text_of(option_named("new voxel", "--edge")["kind"]), "number");
  EXPECT_EQ(text_of(option_named("run", "--json")["kind"]), "switch");
  const auto solver = option_named("run", "--solver");
  EXPECT_EQ(text_of(solver["kind"]), "choice");
  EXPECT_EQ(solver["choices"].dump(), R"(["force","xpbd"])");
  const auto device = option_named("run", "--device");
  EXPECT_EQ(text_of(device["kind"]), "text");  // cuda:3 is accepted, too
  EXPECT_TRUE(holds(device["choices"], "cpu"));
  EXPECT_TRUE(holds(option_named("run", "--random")["choices"], "voxel"));
  EXPECT_EQ(option_named("run", "--record")["extensions"].dump(), R"([".h5"])");
  const auto output = option_named("new voxel", "-o");
  EXPECT_EQ(text_of(output["kind"]), "path");
  EXPECT_EQ(output["extensions"].dump(), R"([".json",".cbor"])");
  EXPECT_TRUE(output["required"]);
  const auto robots = option_named("run", "ROBOTS");
  EXPECT_TRUE(robots["positional"] && robots["many"] && !robots["required"]);
  EXPECT_EQ(text_of(option_named("evolve", "RUN")["kind"]), "folder");
}

}  // namespace
}  // namespace mercury::test
