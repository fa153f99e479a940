// SPDX-License-Identifier: Apache-2.0
// Hostile input, through every command: one printable line of ours, exit status 1 or 2.
#include <gmock/gmock.h>
#include <sys/stat.h>

#include <algorithm>
#include <map>
#include <sstream>

#include "app/base/messages.h"
#include "tests/app/program.h"

namespace mercury::test {
namespace {

// Words that only a library would say to a user.
constexpr const char* library_words[] = {"json.exception",
                                         "std::",
                                         "filesystem error",
                                         "basic_string",
                                         "vector::",
                                         "toml::",
                                         "toml++",
                                         "H5F",
                                         "H5D",
                                         "nlohmann",
                                         "terminate",
                                         "what():",
                                         "CLI",
                                         "_M_",
                                         "Assertion",
                                         "Error while"};

class HostileInput : public FolderTest {
 protected:
  HostileInput() {
    mercury({"new", "voxel", "-o", path("good.json"), "--voxels", "2x2x2", "--air", "0"});
    std::string all_bytes;
    for (int byte = 0; byte < 256; ++byte) all_bytes += static_cast<char>(byte);
    const std::map<std::string, std::string> contents{
        {"empty", ""},
        {"open", "["},
        {"object", "{}"},
        {"utf8", "{\"name\": \"\xff\xfe\"}"},
        {"control", std::string("{\"na\x1b\0me\":\n1}", 14)},
        {"deep", std::string(100000, '[')},
        {"bytes", all_bytes},
        {"types", R"({"format": "mercury-robot", "version": 1, "name": [1], "masses": {}, "springs": 3})"},
        {"escape", R"({"format": "\u001b[31mred\nline\u202e", "version": "\u0007"})"},
        {"long", "{\"format\": \"" + std::string(10'000'000, 'A') + "\"}"}};
    for (const auto& [name, content] : contents)
      for (const char* extension : {".json", ".cbor", ".repro", ".h5", ".toml"})
        write(std::string(name).append(extension), content);
    std::filesystem::create_directories(folder_ / "run");
    write("run/run.toml", "x = [");
  }

  void expect_one_line(const Arguments& arguments) const {
    const Outcome outcome = mercury(arguments);
    std::string shown;
    for (const std::string& argument : arguments) shown.append(printable(argument, 100)).append(" ");
    SCOPED_TRACE(shown);
    EXPECT_TRUE(outcome.status == 1 || outcome.status == 2) << outcome.status;
    const std::string& text = outcome.messages;
    EXPECT_EQ(std::count(text.begin(), text.end(), '\n'), 1) << text;
    EXPECT_TRUE(text.starts_with("mercury: ")) << text;
    EXPECT_LT(text.size(), 1000u);
    const std::string line = text.substr(0, text.size() - 1);
    EXPECT_EQ(line, printable(line, 10000));
    for (const char* word : library_words) EXPECT_EQ(text.find(word), std::string::npos) << text;
  }

  std::vector<std::string> hostile_files(const std::string& extension) const {
    std::vector<std::string> files;
    for (const std::string& file : listing())
      if (file.ends_with(extension) && file != "good.json") files.push_back(path(file));
    return files;
  }
};

TEST_F(HostileInput, InRobotFiles) {
  for (const char* extension : {".json", ".cbor"})
    for (const std::string& file : hostile_files(extension)) {
      expect_one_line({"run", file, "--seconds", "0.01", "--device", "cpu"});
      expect_one_line({"info", file});
      expect_one_line({"mutate", file, "-o", path("out/")});
    }
  for (const std::string& file : hostile_files(".json")) {
    expect_one_line({"render", file, "--still", "0", "-o", path("o.png")});
    expect_one_line({"grow", file, "-o", path("out/")});
    expect_one_line({"cross", file, path("good.json"), "-o", path("out/")});
    expect_one_line({"evolve", path("new-run"), "--from", file, "--seconds", "0.01"});
    expect_one_line({"view", file});
  }
}

TEST_F(HostileInput, InRecordingsAndRepros) {
  for (const std::string& file : hostile_files(".h5")) {
    expect_one_line({"info", file});
    expect_one_line({"render", file, "-o", path("o.gif")});
  }
  for (const std::string& file : hostile_files(".repro")) {
    expect_one_line({"run", file});
    expect_one_line({"view", file});
  }
}

TEST_F(HostileInput, InConfigurationsCamerasAndRuns) {
  for (const std::string& file : hostile_files(".toml"))
    if (!file.ends_with("empty.toml")) expect_one_line({"run", path("good.json"), "--config", file});
  for (const std::string& file : hostile_files(".json"))
    expect_one_line({"render", path("good.json"), "--still", "0", "-o", path("o.png"), "--camera", file});
  expect_one_line({"info", path("run")});
  expect_one_line({"evolve", path("run"), "--resume"});
}

TEST_F(HostileInput, InNames) {
  const std::string escape = "\x1b[31mred\nline", broken = "\xff\xfe", long_name(100'000, 'A');
  for (const std::string& name : {escape, broken, long_name})
    for (const char* extension : {"", ".json", ".h5", ".repro", "/"}) {
      const std::string file = std::string(name).append(extension);
      expect_one_line({"run", file});
      expect_one_line({"info", file});
      expect_one_line({"render", file, "-o", path("o.gif")});
      expect_one_line({"evolve", path("new-run"), "--from", file});
    }
  for (const std::string& name : {escape, broken, long_name}) {
    expect_one_line({name});
    expect_one_line({"help", name});
    expect_one_line({"new", name});
    expect_one_line({std::string("--").append(name), "run"});
    expect_one_line({"run", std::string("--").append(name)});
    expect_one_line({"run", "--dt", name});
    expect_one_line({"run", "--random", name});
    expect_one_line({"run", "--solver", name});
    expect_one_line({"run", "--config", name});
    expect_one_line({"render", path("good.json"), "-o", std::string(name).append(".avi")});
    expect_one_line({"render", path("good.json"), "--still", "0", "-o", path("o.png"), "--camera", name});
    expect_one_line({"bench", "--size", name});
    expect_one_line({"evolve", path("new-run"), "--objective", name});
    expect_one_line({"evolve", path("new-run"), "--axis", name});
    expect_one_line({"evolve", name, "--resume"});
  }
}

// What a person reads shows escapes, in as many lines as always.
TEST_F(HostileInput, InTheNameOfARobotDoesNotReachTheTerminal) {
  nlohmann::json robot = nlohmann::json::parse(read("good.json"));
  const std::string plain = "A", hostile = "\x1b[31mred\nline\x07\xe2\x80\xae";
  const auto output = [&](const std::string& name, std::vector<std::string> arguments) {
    robot["name"] = name;
    robot["actuators"] = {{{"name", name}, {"materials", {1}}}};
    write("named.json", robot.dump());
    mercury({"run", path("named.json"), "--seconds", "0.01", "--device", "cpu", "--record", path("named.h5"), "--force",
             "-q"});
    return mercury(arguments).output;
  };
  const std::vector<std::vector<std::string>> commands{
      {"info", path("named.json")},
      {"info", path("named.h5")},
      {"run", path("named.json"), "--seconds", "0.01", "--device", "cpu"},
      {"mutate", path("named.json"), "-o", path("child.json"), "--dry-run"}};
  for (const Arguments& arguments : commands) {
    SCOPED_TRACE(arguments[0] + " " + arguments[1]);
    const std::string expected = output(plain, arguments), shown = output(hostile, arguments);
    EXPECT_EQ(std::count(shown.begin(), shown.end(), '\n'), std::count(expected.begin(), expected.end(), '\n'))
        << shown;
    std::istringstream lines(shown);
    for (std::string line; std::getline(lines, line);) EXPECT_EQ(line, printable(line, 10'000));
  }
}

// JSON and CSV hold the name of a robot as it is, in one value and in one field.
TEST_F(HostileInput, InTheNameOfARobotStaysOneValue) {
  nlohmann::json robot = nlohmann::json::parse(read("good.json"));
  robot["name"] = "\x1b[31mred\nline\"quoted\",\xe2\x80\xae";
  write("named.json", robot.dump());
  const auto run = [&](const Arguments& more) {
    return mercury(joined({"run", path("named.json"), "--seconds", "0.01", "--device", "cpu"}, more)).output;
  };
  const auto json = nlohmann::json::parse(run({"--json"}), nullptr, false);
  EXPECT_EQ(json["robots"][0]["name"].get<std::string>(), robot["name"].get<std::string>());
  EXPECT_NE(run({"--csv", "-"}).find("\"\x1b[31mred\nline\"\"quoted\"\",\xe2\x80\xae\""), std::string::npos);
}

// A name of 10 MB takes one line of reasonable length.
TEST_F(HostileInput, InTheLengthOfANameTakesOneLine) {
  nlohmann::json robot = nlohmann::json::parse(read("good.json"));
  robot["name"] = std::string(10'000'000, 'n');
  write("named.json", robot.dump());
  robot["format"] = robot["name"];
  write("bad.json", robot.dump());
  for (const Arguments& arguments : std::vector<std::vector<std::string>>{
           {"info", path("named.json")},
           {"run", path("named.json"), "--seconds", "0.01", "--device", "cpu"},
           {"run", path("bad.json")},
           {"mutate", path("named.json"), "-o", path("child.json"), "--dry-run"},
           {"render", path("named.json"), "-o", path("a.mp4"), "--each", "--dry-run"},
           {"render", path("named.json"), "-o", path("a.png"), "--camera", "follow:none"},
           {"export", path("named.json"), "-o", path("a.glb"), "--robot", "none"}}) {
    const Outcome outcome = mercury(arguments);
    std::istringstream lines(outcome.output + outcome.messages);
    for (std::string line; std::getline(lines, line);)
      EXPECT_LE(line.size(), 1000u) << testing::PrintToString(arguments);
  }
  for (const char* option : {"--dt", "--axis", "--from", "--config", "--random", "--solver"}) {
    const Outcome outcome = mercury({"evolve", path("run"), option, std::string(100'000, 'n')});
    EXPECT_EQ(outcome.status, 2) << option;
    EXPECT_LE(outcome.messages.size(), 1000u) << option;
  }
}

}  // namespace
}  // namespace mercury::test
