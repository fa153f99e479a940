// SPDX-License-Identifier: Apache-2.0
// A scene file takes the place of robots and options in every command.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "mercury/random_voxel.h"
#include "mercury/real_body.h"
#include "mercury/robot_file.h"
#include "tests/app/program.h"

namespace mercury::test {
namespace {

using testing::HasSubstr;
using testing::StartsWith;

constexpr const char* head = "format = \"mercury-scene\"\nversion = 1\n";

class SceneCommand : public FolderTest {
 protected:
  SceneCommand() {
    std::filesystem::create_directory(folder_ / "robots");
    for (std::uint64_t i = 0; i < 2; ++i)
      save_robot(path("robots/" + std::to_string(i) + ".json"),
                 random_voxel_robot({.smallest = {2, 2, 1}, .largest = {2, 2, 1}}, 3, i));
    write("both.toml", std::string(head) + "robots = [\"robots/0.json\", \"robots/1.json\"]\n" + R"(
random = ["voxel:2:5"]
environment = "land"
friction = 0.3
solver = "xpbd"
dt = 0.002
color = "strain"
theme = "light"

[camera]
mode = "still"
azimuth = -2.0
target = [0.0, 0.0, 0.1]
distance = 3.0
)");
  }
  // A scene of these robot files, with more lines.
  std::string scene_of(const std::string& robots, const std::string& lines = "") const {
    write("bodies.toml", head + ("robots = [" + robots + "]\n") + lines);
    return path("bodies.toml");
  }
  // Without what depends on time.
  static nlohmann::json results(const Arguments& arguments) {
    const Outcome run =
        mercury(joined(arguments, {"--device", "cpu", "--threads", "1", "--seconds", "0.2", "--json", "--quiet"}));
    EXPECT_EQ(run.status, 0) << run.messages;
    auto document = nlohmann::json::parse(run.output, nullptr, false);
    document.erase("wall_seconds");
    document.erase("springs_per_second");
    return document;
  }
  std::vector<std::string> options() const {
    return {path("robots/0.json"), path("robots/1.json"), "--random",      "voxel:2:5",
            "--environment=land",  "--friction=0.3",      "--solver=xpbd", "--dt=0.002"};
  }
  std::vector<std::string> with(const std::string& command, const Arguments& more = {}) const {
    return joined({command}, options(), more);
  }
  std::string refusal(const std::string& text) const {
    write("bad.toml", text);
    const Outcome run = mercury({"run", path("bad.toml"), "--seconds", "0.01", "--device", "cpu"});
    EXPECT_THAT(run, Ends(2, testing::_)) << text;
    return run.messages;
  }
};

TEST_F(SceneCommand, RunsAsTheSameOptionsDo) { EXPECT_EQ(results({"run", path("both.toml")}), results(with("run"))); }

TEST_F(SceneCommand, IsOverriddenByTheCommandLine) {
  EXPECT_EQ(results({"run", path("both.toml"), "--dt", "0.001", "--friction=0.9"}),
            results(with("run", {"--dt=0.001", "--friction=0.9"})));
  EXPECT_EQ(results({"run", "--random", "voxel:1:9", path("both.toml")}),
            results({"run", path("robots/0.json"), path("robots/1.json"), "--random", "voxel:1:9", "--environment=land",
                     "--friction=0.3", "--solver=xpbd", "--dt=0.002"}));
  // Another environment does not take the parameters of the scene's own.
  EXPECT_EQ(results({"run", path("both.toml"), "--environment", "ocean"}),
            results({"run", path("robots/0.json"), path("robots/1.json"), "--random", "voxel:2:5",
                     "--environment=ocean", "--solver=xpbd", "--dt=0.002"}));
  // Robots beside the scene are added in their place.
  EXPECT_EQ(results({"run", path("robots/1.json"), path("both.toml")})["robots"].size(), 5u);
}

TEST_F(SceneCommand, IsOverriddenByAConfigurationFile) {
  write("more.toml", "dt = 0.001\n");
  EXPECT_EQ(results({"run", path("both.toml"), "--config", path("more.toml")}), results(with("run", {"--dt=0.001"})));
}

TEST_F(SceneCommand, RendersAsTheSameOptionsDo) {
  write("camera.json", R"({"format": "mercury-camera", "version": 1, "mode": "still", "azimuth": -2.0,
    "target": [0, 0, 0.1], "distance": 3})");
  const std::vector<std::string> picture{"--seconds", "0.1",      "--fps", "10", "--size",
                                         "160x120",   "--device", "cpu",   "-o"};
  const auto rendered = [&](const Arguments& arguments, const std::string& to) {
    const Outcome run = succeeded(mercury(joined(arguments, picture, {path(to)})));
    std::string all;
    for (const std::string& name : run.status == 0 ? listing(to) : std::vector<std::string>{})
      all += read(to + "/" + name);
    return all;
  };
  const std::string of_scene = rendered({"render", path("both.toml")}, "scene/");
  EXPECT_FALSE(of_scene.empty());
  EXPECT_TRUE(of_scene == rendered(with("render", {"--color=strain", "--theme=light", "--camera", path("camera.json")}),
                                   "options/"));
  EXPECT_TRUE(of_scene != rendered({"render", path("both.toml"), "--theme", "dark"}, "dark/"));
}

TEST_F(SceneCommand, IsDescribed) {
  const Outcome text = succeeded(mercury({"info", path("both.toml")}));
  for (const char* part : {"both.toml", "robots/0.json", "2 of kind voxel, seed 5", "land", "xpbd", "still", "strain"})
    EXPECT_THAT(text.output, HasSubstr(part));
  const auto json = nlohmann::json::parse(mercury({"info", path("both.toml"), "--json"}).output)["scenes"][0];
  EXPECT_EQ(json["robots"].size(), 2u);
  EXPECT_EQ(json["random"][0]["count"], 2);
  EXPECT_EQ(json["configuration"]["environment"], "land");
  EXPECT_EQ(json["configuration"]["dt"], 0.002);
  EXPECT_EQ(json["color"], "strain");
  EXPECT_EQ(json["camera"], "still");
}

TEST_F(SceneCommand, OfFilesAloneIsTakenByCommandsThatMakeNoRandomRobots) {
  write("files.toml", std::string(head) + "robots = [\"robots/0.json\"]\ncolor = \"strain\"\n");
  EXPECT_EQ(mercury({"mutate", path("files.toml"), "-o", path("child.json"), "--quiet"}).status, 0);
  EXPECT_THAT(mercury({"mutate", path("both.toml"), "-o", path("children/")}),
              Ends(2, HasSubstr("both.toml: has random robots, which mercury mutate does not take")));
}

TEST_F(SceneCommand, ThatBreaksARuleIsRefusedInOneLineWithItsPlace) {
  const std::string bad = "mercury: " + path("bad.toml"), robots = "robots = [\"robots/0.json\"]\n";
  EXPECT_THAT(refusal(""), StartsWith(bad + ": is not a scene: format = \"mercury-scene\" is missing"));
  EXPECT_THAT(refusal("dt = 0.1\n"), StartsWith(bad + ": is not a scene"));
  EXPECT_THAT(refusal("format = 3\n"), StartsWith(bad + ": is not a scene"));
  EXPECT_THAT(refusal("format = \"mercury-scene\"\nversion = 2\n"), StartsWith(bad + ":2: is not of version 1"));
  EXPECT_THAT(refusal("format = \"mercury-scene\"\n"), StartsWith(bad + ": is not of version 1"));
  EXPECT_THAT(refusal("format = \"mercury-scene\"\nversion = 1\nrobots = [\n"), StartsWith(bad + ":"));
  EXPECT_THAT(refusal(head + std::string("robots = \"eel.json\"\n")), StartsWith(bad + ":3: robots must be a list"));
  EXPECT_THAT(refusal(head + std::string("robots = [3]\n")), StartsWith(bad + ":3: robots must be a list"));
  EXPECT_THAT(refusal(head + std::string("robots = [\"\"]\n")), StartsWith(bad + ":3: robots must be a list"));
  EXPECT_THAT(refusal(head + std::string("robots = [\"none.json\"]\n")), HasSubstr("none.json"));
  EXPECT_THAT(refusal(head + std::string("robots = [\"bad.toml\"]\n")), HasSubstr("bad.toml"));
  EXPECT_THAT(refusal(head + std::string("robots = []\n")), HasSubstr("no robots given"));
  EXPECT_THAT(refusal(head + robots + "dt = -1\n"), StartsWith(bad + ":4: --dt: -1 is not accepted"));
  EXPECT_THAT(refusal(head + robots + "dt = \"x\"\n"), StartsWith(bad + ":4: --dt"));
  EXPECT_THAT(refusal(head + robots + "enviroment = \"land\"\n"),
              StartsWith(bad + ":4: \"enviroment\" is not a key of a scene; did you mean environment?"));
  EXPECT_THAT(refusal(head + robots + "friction = 0.5\nenvironment = \"ocean\"\n"), HasSubstr(":4: --friction"));
  EXPECT_THAT(refusal(head + robots + "color = \"stran\"\n"), StartsWith(bad + ":4: --color"));
  EXPECT_THAT(refusal(head + robots + "caption = \"\"\n"), StartsWith(bad + ":4: --caption is empty"));
  EXPECT_THAT(refusal(head + robots + "random = [\"voxel:0\"]\n"), StartsWith(bad + ":4: --random"));
  EXPECT_THAT(refusal(head + robots + "random = [\"voxel:99999999999999999999\"]\n"), StartsWith(bad + ":4: --random"));
  EXPECT_THAT(refusal(head + robots + "[camera]\nmode = \"stil\"\n"), StartsWith(bad + ":4: --camera: /mode must be"));
  EXPECT_THAT(refusal(head + robots + "[camera]\nmod = \"still\"\n"),
              StartsWith(bad + ":5: \"mod\" is not a key of [camera]; did you mean mode?"));
  EXPECT_THAT(refusal(head + robots + "[camera]\ndistance = nan\n"), StartsWith(bad + ":4: --camera"));
  EXPECT_THAT(refusal(head + robots + "[camera]\ndistance = 1e300\n"), StartsWith(bad + ":4: --camera"));
  EXPECT_THAT(refusal(head + robots + "[run]\ndt = 1\n"), StartsWith(bad + ":4: [run] is not a table of a scene"));
  // A scene writes no files and chooses no device.
  for (const char* key : {"csv = \"x.csv\"", "record = \"x.h5\"", "output = \"x.mp4\"", "force = true",
                          "config = \"a\"", "device = \"cpu\"", "threads = 2", "keep-going = true"})
    EXPECT_THAT(refusal(head + robots + key + "\n"), HasSubstr("is not a key of a scene")) << key;
  EXPECT_THAT(mercury({"run", path("both.toml"), path("both.toml")}),
              Ends(2, HasSubstr("is a second scene; give one")));
  EXPECT_EQ(mercury({"run", path("missing.toml")}).status, 2);
  EXPECT_EQ(mercury({"info", path("bad.toml")}).status, 2);
}

// The scene does not name the physics; its robots do.
TEST_F(SceneCommand, RealBodiesRunInTheirWater) {
  save_robot(path("robots/real.json"), with_real_body(random_voxel_robot({}, 3, 0), {}));
  const std::string scene = scene_of("\"robots/real.json\"");
  EXPECT_EQ(results({"run", scene})["configuration"]["environment"], "water");
  EXPECT_EQ(results({"run", scene})["robots"][0]["physics"], "real");
  EXPECT_THAT(mercury({"info", scene}).output, HasSubstr("water"));
}

TEST_F(SceneCommand, BodiesOfBothPhysicsAreRefused) {
  save_robot(path("robots/real.json"), with_real_body(random_voxel_robot({}, 3, 0), {}));
  const std::string robots = "\"robots/real.json\", \"robots/0.json\"";
  for (const char* command : {"run", "info"}) {
    EXPECT_THAT(mercury({command, scene_of(robots)}),
                Ends(2, HasSubstr("one has a real body, the other that of the paper")));
  }
  EXPECT_EQ(results({"run", scene_of(robots, "physics = \"real\"\n")})["robots"][1]["physics"], "real");
}

}  // namespace
}  // namespace mercury::test
