// SPDX-License-Identifier: Apache-2.0
// mercury import as users call it: robots, configurations and reports, and one line for what cannot be used.
#include <gmock/gmock.h>

#include <fmt/format.h>

#include <cmath>
#include <filesystem>

#include "mercury/robot_file.h"
#include "mercury/voxel.h"
#include "tests/app/program.h"
#include "tests/robots/importers/documents.h"

namespace mercury::test {
namespace {

using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::Not;

class ImportCommand : public FolderTest {
 protected:
  ImportCommand() { write("crawler.vxa", VxaParts{}.text()); }
  static void refuses(const Arguments& arguments, const std::string& message) {
    const Outcome outcome = mercury(joined({"import"}, arguments));
    EXPECT_EQ(outcome.status, 2);
    EXPECT_EQ(outcome.output, "");
    EXPECT_EQ(outcome.messages, fmt::format("mercury: {}\n", message));
  }
  const std::string terrain_ = R"({"grid_width": 2, "grid_height": 1, "objects": {
      "ground": {"indices": [0, 1], "types": [5, 5], "neighbors": {}}}})";
};

TEST_F(ImportCommand, WritesRobotAndWorldThatRunTogether) {
  const Outcome outcome = succeeded(mercury({"import", path("crawler.vxa"), "-o", path("robots")}));
  EXPECT_THAT(listing("robots"), ElementsAre("crawler.json", "crawler.toml"));
  EXPECT_THAT(outcome.output, HasSubstr("/VXA/VXC/Palette/Material[1]/Mechanical/CTE"));
  const Robot robot = load_robot(path("robots/crawler.json"));
  EXPECT_EQ(robot.name, "crawler");
  EXPECT_EQ(voxel_grid_of(robot)->cells, (std::vector<MaterialId>{1, 2, 0, 3}));
  const Outcome run = succeeded(mercury({"run", path("robots/crawler.json"), "--config", path("robots/crawler.toml"),
                                         "--seconds", "0.2", "--device", "cpu", "--json"}));
  const auto result = nlohmann::json::parse(run.output);
  EXPECT_EQ(result["configuration"]["environment"], "land");
  EXPECT_EQ(result["robots"][0]["fate"], "sound");
}

TEST_F(ImportCommand, ReportsAsJson) {
  const Outcome outcome = succeeded(mercury({"import", path("crawler.vxa"), "-o", path("robots"), "--json"}));
  const auto report = nlohmann::json::parse(outcome.output)["files"][0];
  EXPECT_EQ(report["file"], path("crawler.vxa"));
  EXPECT_EQ(report["robots"][0], path("robots/crawler.json"));
  EXPECT_EQ(report["configuration"], path("robots/crawler.toml"));
  EXPECT_EQ(report["time_scale"], 2);
  EXPECT_GT(report["elements"].size(), 30u);
  for (const auto& element : report["elements"]) {
    EXPECT_THAT(element["outcome"].get<std::string>(), testing::AnyOf("mapped", "approximated", "ignored"));
    EXPECT_NE(element["reason"], "");
  }
}

TEST_F(ImportCommand, SaysWhenNothingWasImported) {
  write("terrain.json", terrain_);
  write("base.vxa", "<VXA Version=\"1.0\"><VXC/></VXA>");
  const Outcome nothing = mercury({"import", path("terrain.json"), path("base.vxa"), "-o", path("robots"), "--brief"});
  EXPECT_EQ(nothing.status, 1);
  EXPECT_THAT(nothing.messages, HasSubstr("base.vxa: no robot in it: it has no voxels"));
  EXPECT_THAT(nothing.messages, testing::EndsWith("mercury: nothing was imported\n"));
  EXPECT_FALSE(std::filesystem::exists(path("robots")));
  const Outcome some =
      succeeded(mercury({"import", path("crawler.vxa"), path("base.vxa"), "-o", path("robots"), "--brief"}));
  EXPECT_THAT(some.messages, HasSubstr("no robot in it"));
}

TEST_F(ImportCommand, AHistoryBecomesARecordingThatPlays) {
  std::string text = "{{{setting}}}<rescale>0.001</rescale>\n{{{setting}}}<voxel_size>0.01</voxel_size>\n";
  for (int i = 0; i < 5; ++i)
    text += fmt::format("<<<Step{} Time:{}>>>{},0,0,0,0,0,0,-5,-5,-5,5,5,5,1,0,;<<<>>>\n", 10 * i, 0.01 * i, i);
  write("bot.history", text);
  const Outcome outcome = succeeded(mercury({"import", path("bot.history"), "-o", path("motions"), "--brief"}));
  EXPECT_THAT(listing("motions"), ElementsAre("bot.h5"));
  EXPECT_THAT(outcome.output, HasSubstr("a motion to play, not a robot to simulate"));
  succeeded(mercury({"info", path("motions/bot.h5"), "--json"}));
  // 1 mm per 0.01 s, ten times as large and the square root of that as slow.
  succeeded(mercury({"export", path("motions/bot.h5"), "-o", path("bot.html")}));
  EXPECT_THAT(read("bot.html"), HasSubstr(fmt::format("0.04 m in {:.3g} s", 0.04 * std::sqrt(10.0))));
  EXPECT_EQ(mercury({"run", path("bot.history")}).status, 2);
}

TEST_F(ImportCommand, FoldersGiveAllRobotsAndOneConfiguration) {
  std::filesystem::create_directories(path("run"));
  write("run/base.vxa", VxaParts{}.text());
  write("run/a.vxd", "<VXD/>");
  write("run/b.vxd", "<VXD/>");
  write("run/note.txt", "");
  write("run/robot.json", "{\"format\": \"mercury-robot\"}");
  const Outcome outcome = succeeded(mercury({"import", path("run"), "-o", path("robots"), "--brief"}));
  EXPECT_THAT(listing("robots"), ElementsAre("a.json", "a.toml", "b.json", "b.toml", "import.toml"));
  EXPECT_THAT(outcome.output, HasSubstr("on the base " + path("run/base.vxa")));
  EXPECT_THAT(outcome.output, testing::Not(HasSubstr("Mechanical")));
  EXPECT_EQ(mercury({"run", path("robots"), "--config", path("robots/import.toml"), "--seconds", "0.1"}).status, 0);
}

TEST_F(ImportCommand, FilesOfOneNameDoNotReplaceEachOther) {
  std::filesystem::create_directories(path("other"));
  write("other/crawler.vxa", VxaParts{}.text());
  succeeded(mercury({"import", path("crawler.vxa"), path("other/crawler.vxa"), "-o", path("robots")}));
  EXPECT_THAT(listing("robots"),
              ElementsAre("crawler-2.json", "crawler-2.toml", "crawler.json", "crawler.toml", "import.toml"));
}

TEST_F(ImportCommand, TerrainAloneIsReported) {
  write("world.json", terrain_);
  const Outcome outcome = mercury({"import", path("world.json"), "-o", path("robots")});
  EXPECT_EQ(outcome.status, 1);
  EXPECT_THAT(outcome.messages, HasSubstr("no robot in it"));
  EXPECT_THAT(outcome.output, HasSubstr("fixed terrain"));
}

TEST_F(ImportCommand, KeepGoingLeavesBadFilesOut) {
  write("bad.vxa", "<VXA/>");
  const Arguments arguments{"import", path("bad.vxa"), path("crawler.vxa"), "-o", path("robots")};
  EXPECT_EQ(mercury(arguments).status, 2);
  EXPECT_FALSE(std::filesystem::exists(path("robots")));
  EXPECT_EQ(mercury(joined(arguments, {"--keep-going"})).status, 1);
  EXPECT_THAT(listing("robots"), ElementsAre("crawler.json", "crawler.toml"));
}

TEST_F(ImportCommand, RefusesWhatCannotBeUsed) {
  write("bad.vxa", "<VXA/>");
  write("lonely.vxd", "<VXD/>");
  refuses({path("bad.vxa"), "-o", path("r")}, path("bad.vxa") + ": /VXA: has no element VXC, which holds the voxels");
  refuses({path("none.vxa"), "-o", path("r")}, path("none.vxa") + ": No such file or directory");
  refuses({path("lonely.vxd"), "-o", path("r")},
          path("lonely.vxd") + ": a .vxd changes a base, and no base.vxa is beside it; name one with --base");
  refuses({path("crawler.vxa"), "-o", path("r"), "--depth", "0"}, "--depth: give 1 to 100 voxels");
  refuses({path("crawler.vxa"), "-o", path("r"), "--materials", "500"}, "--materials: give 8 to 255 materials");
  EXPECT_FALSE(std::filesystem::exists(path("r")));
}

TEST_F(ImportCommand, ExistingFilesAreKept) {
  succeeded(mercury({"import", path("crawler.vxa"), "-o", path("robots")}));
  refuses({path("crawler.vxa"), "-o", path("robots")},
          "-o: " + path("robots/crawler.json") + " exists already; use --force to replace it, or give another name");
  EXPECT_EQ(mercury({"import", path("crawler.vxa"), "-o", path("robots"), "--force"}).status, 0);
}

TEST_F(ImportCommand, CommandsTakeSuchFilesDirectly) {
  const Outcome outcome = succeeded(mercury({"run", path("crawler.vxa"), "--seconds", "0.1", "--device", "cpu"}));
  EXPECT_THAT(outcome.output, HasSubstr("crawler"));
  EXPECT_THAT(outcome.messages, HasSubstr("imported without its world"));
  EXPECT_EQ(mercury({"info", path("crawler.vxa")}).status, 0);
}

TEST_F(ImportCommand, ExportedVoxelRobotsComeBack) {
  succeeded(mercury({"new", "voxel", "--seed", "3", "-o", path("eel.json")}));
  succeeded(mercury({"export", path("eel.json"), "-o", path("eel.vxa")}));
  succeeded(mercury({"import", path("eel.vxa"), "-o", path("back")}));
  const Robot there = load_robot(path("eel.json")), back = load_robot(path("back/eel.json"));
  EXPECT_EQ(voxel_grid_of(back)->cells, largest_body(*voxel_grid_of(there)).cells);
}

// Water there pushes outward faces alone, so a rigid body needs twice the coefficient for the drag that it has here on
// two sides.
TEST_F(ImportCommand, ExportedWaterComesBackOneSided) {
  succeeded(mercury({"new", "voxel", "--seed", "3", "-o", path("eel.json")}));
  const auto back_in = [&](const Arguments& water) {
    const Arguments arguments{"export",    path("eel.json"),
                              "-o",        path("eel.vxa"),
                              "--force",   "--environment",
                              "resistive", "--normal-coefficient",
                              "0.7",       "--tangential-coefficient",
                              "0",         "--added-mass-coefficient",
                              "0"};
    const Outcome outcome = succeeded(mercury(joined(arguments, water)));
    succeeded(mercury({"import", path("eel.vxa"), "-o", path("back"), "--force"}));
    return outcome.messages + read(path("back/eel.toml"));
  };
  EXPECT_THAT(back_in({"--one-sided"}), AllOf(HasSubstr("normal-coefficient = 0.7\n"), HasSubstr("one-sided = true"),
                                              Not(HasSubstr("water there"))));
  EXPECT_THAT(back_in({}), AllOf(HasSubstr("normal-coefficient = 1.4\n"), HasSubstr("one-sided = true"),
                                 HasSubstr("water there is one-sided")));
}

}  // namespace
}  // namespace mercury::test
