// SPDX-License-Identifier: Apache-2.0
// mercury render: results of mercury run, and several columns in one film.
#include <gmock/gmock.h>

#include <algorithm>
#include <set>

#include "render/png.h"
#include "tests/app/commands/small_run.h"
#include "tests/app/program.h"

namespace mercury::test {
namespace {

using testing::HasSubstr;

// Some columns of a picture.
render::Image columns(const render::Image& picture, int first, int width) {
  render::Image cut{.width = width, .height = picture.height, .bytes = {}};
  for (int row = 0; row < picture.height; ++row) {
    const auto begin = picture.bytes.begin() + 3 * (row * picture.width + first);
    cut.bytes.insert(cut.bytes.end(), begin, begin + 3 * width);
  }
  return cut;
}

class RenderSides : public FolderTest {
 protected:
  Outcome two_robots(const std::string& output, const Arguments& more) const {
    return succeeded(
        mercury(joined({"render", "--random", "voxel:2", "--faceted", "--show", "skin"}, more, {"-o", path(output)})));
  }
};

// Each half is the picture of its recording, but for camera and captions, which stand in the corners.
TEST_F(RenderSides, TwoRecordingsPlaySideBySide) {
  const auto record = [&](const std::string& name, const std::string& robots, const std::string& seconds) {
    return mercury({"run", "--random", robots, "--seconds", seconds, "--record", path(name), "--device", "cpu"}).status;
  };
  ASSERT_EQ(record("one.h5", "voxel:1", "0.2"), 0);
  ASSERT_EQ(record("other.h5", "voxel:2:7", "0.4"), 0);
  const std::vector<std::string> sides{"render", path("one.h5"), path("other.h5"), "--size", "320x120", "--fps", "10"};
  succeeded(mercury(joined(sides, {"-o", path("sides")})));
  EXPECT_EQ(listing("sides").size(), 4u);  // as long as the longer one
  const render::Image first = render::read_png(path("sides/frame-00000.png")),
                      last = render::read_png(path("sides/frame-00003.png"));
  const auto half = [](const render::Image& image, int begin) {
    std::vector<std::uint8_t> bytes;
    for (int y = 30; y < 90; ++y)
      for (int x = begin + 20; x < begin + 140; ++x)
        bytes.push_back(image.bytes[3 * (static_cast<std::size_t>(y) * 320 + static_cast<std::size_t>(x))]);
    return bytes;
  };
  EXPECT_NE(half(first, 0), half(first, 160));
  EXPECT_NE(half(first, 160), half(last, 160));
  const std::string one = path("one.h5");
  EXPECT_THAT(mercury({"render", one, one, one, one, one, "-o", path("a.mp4")}).messages,
              HasSubstr("at most 4 recordings, results and runs stand side by side"));
}

// Three columns of one recording are the same picture three times; a run stands beside a recording.
TEST_F(RenderSides, RecordingsAndRunsStandSideBySide) {
  succeeded(mercury({"run", "--random", "voxel:1", "--seconds", "0.1", "--record", path("a.h5")}));
  const std::string one = path("a.h5");
  succeeded(mercury(
      {"render", one, one, one, "--size", "300x90", "--still", "0.1", "-o", path("three.png"), "--show", "skin"}));
  const render::Image three = render::read_png(path("three.png"));
  ASSERT_EQ(three.width, 300);
  EXPECT_EQ(columns(three, 0, 100).bytes, columns(three, 100, 100).bytes);
  EXPECT_EQ(columns(three, 0, 100).bytes, columns(three, 200, 100).bytes);

  make_run(path("run"), small_run(), 2);
  const std::vector<std::string> sides{"render", path("run"),    one,     "--size", "320x90", "--seconds",
                                       "0.1",    "--background", "white", "--show", "skin"};
  for (const Arguments& film : {Arguments{"--still", "0.1", "-o", path("both.png")}, {"-o", path("both.mp4")}}) {
    succeeded(mercury(joined(sides, film)));
  }
  const render::Image both = render::read_png(path("both.png"));
  for (const int begin : {0, 160}) {
    const std::vector<std::uint8_t> side = columns(both, begin, 160).bytes;
    EXPECT_EQ(side[0], 255);
    EXPECT_GT(std::ranges::count_if(side, [](int byte) { return byte < 200; }), 100) << begin;
  }
  EXPECT_EQ(probe(path("both.mp4"))["nb_read_frames"], "3");
  EXPECT_THAT(mercury({"render", path("run"), one, "--lineage", "best", "-o", path("c.mp4")}).messages,
              HasSubstr("--lineage: is of one run"));
}

// A camera that stays where the start put it, when both sides are alike, is the same for one side and for two.
TEST_F(RenderSides, EachSideOfAComparisonIsThePictureOfItsSettings) {
  const auto picture = [this](const std::string& name, const std::string& size, const Arguments& more) {
    two_robots(name, joined(more, {"--size", size, "--fps", "2", "--seconds", "1", "--camera", "still", "--color",
                                   "strain", "--scale", "-0.2,0.2", "--dt", "0.0005"}));
    return render::read_png(path(name + "/frame-00001.png"));
  };
  const render::Image both = picture("both", "320x90", {"--compare", "solver=xpbd"});
  EXPECT_EQ(both.width, 320);
  EXPECT_EQ(columns(both, 0, 160).bytes, picture("force", "160x90", {"--caption", "force solver"}).bytes);
  EXPECT_EQ(columns(both, 160, 160).bytes, picture("xpbd", "160x90", {"--solver", "xpbd", "--caption", "XPBD"}).bytes);
  EXPECT_NE(columns(both, 0, 160).bytes, columns(both, 160, 160).bytes);
}

TEST_F(RenderSides, SidesOfAFilmShareCameraAndScale) {
  // Equal settings: whatever the camera and the colors do over time, both sides do it.
  two_robots("even", {"--fps", "4", "--seconds", "1", "--size", "320x90", "--color", "speed", "--compare", "dt=0.001"});
  for (const std::string& frame : listing("even")) {
    const render::Image picture = render::read_png(path("even/" + frame));
    EXPECT_EQ(columns(picture, 0, 160).bytes, columns(picture, 160, 160).bytes) << frame;
  }
  // Different settings: a film of both in one file.
  const Outcome film =
      two_robots("a.mp4", {"--size", "160x90", "--fps", "20", "--seconds", "0.5", "--compare", "environment=land"});
  EXPECT_THAT(film.messages, HasSubstr("comparing ocean | land"));
  EXPECT_EQ(probe(path("a.mp4"))["width"], 160);
  EXPECT_EQ(probe(path("a.mp4"))["nb_read_frames"], "10");
}

// What mercury run --json printed names robots, settings and final states.
class RenderResult : public FolderTest {
 protected:
  // The same run as a recording (.h5) and a result (.json).
  std::string run(const std::string& name, const Arguments& robots) const {
    const Outcome outcome = succeeded(mercury(joined({"run"}, robots,
                                                     {"--seconds", "0.2", "--environment", "land", "--friction", "0.3",
                                                      "--device", "cpu", "--json", "--record", path(name + ".h5")})));
    write(name + ".json", outcome.output);
    return name + ".json";
  }
  Outcome film(std::vector<std::string> inputs, const std::string& output) const {
    for (std::string& input : inputs)
      if (input.ends_with(".json") || input.ends_with(".h5")) input = path(input);
    return mercury(
        joined({"render"}, inputs, {"--device", "cpu", "--size", "240x90", "--show", "skin", "-o", path(output)}));
  }
  static std::string with(std::string text, const std::string& what, const std::string& instead) {
    const std::size_t at = text.find(what);
    EXPECT_NE(at, std::string::npos) << what;
    return text.replace(at, what.size(), instead);
  }
};

TEST_F(RenderResult, IsSimulatedAgainBesideARecordingOfTheSameRun) {
  const std::string result = run("walk", {"--random", "voxel:2:7"});
  const Outcome outcome = film({"walk.h5", result, "--still", "0.165"}, "both.png");  // a frame
  ASSERT_EQ(outcome.status, 0) << outcome.messages;
  EXPECT_THAT(outcome.messages, HasSubstr("all final states are those of the result, bit for bit"));
  const render::Image both = render::read_png(path("both.png"));
  const render::Image recorded = columns(both, 0, 120), simulated = columns(both, 120, 120);
  EXPECT_GT(std::set(recorded.bytes.begin(), recorded.bytes.end()).size(), 20u);
  int farthest = 0;
  for (std::size_t i = 0; i < recorded.bytes.size(); ++i)
    farthest = std::max(farthest, std::abs(recorded.bytes[i] - simulated.bytes[i]));
  EXPECT_LE(farthest, 2);  // positions are rounded differently

  const Outcome alone = succeeded(film({result, "--fps", "10"}, "alone"));
  EXPECT_EQ(listing("alone").size(), 2u);  // as long as the run
  EXPECT_THAT(alone.messages, HasSubstr("simulating 2 robots (land)"));
}

TEST_F(RenderResult, ItsMotionIsExported) {
  const std::string result = path(run("walk", {"--random", "voxel:2:7"}));
  const Outcome outcome = succeeded(mercury({"export", result, "-o", path("walk.html"), "--device", "cpu"}));
  EXPECT_THAT(outcome.messages, HasSubstr("all final states are those of the result, bit for bit"));
  EXPECT_THAT(read("walk.html"), HasSubstr("walk.json"));
  const Outcome table =
      succeeded(mercury({"export", result, "-o", path("walk.csv"), "--robot", "1", "--device", "cpu"}));
  EXPECT_THAT(table.messages, HasSubstr("bit for bit"));
  // A pose needs no result: it is that of the robot's file.
  EXPECT_THAT(mercury({"export", result, "-o", path("walk.obj")}),
              Ends(2, HasSubstr("walk.json: is a result of mercury run")));
  EXPECT_THAT(mercury({"export", result, "-o", path("walk.glb"), "--from", "0.1"}),
              Ends(2, HasSubstr("walk.json is a result")));
}

TEST_F(RenderResult, NamesFilesThatLieBesideIt) {
  succeeded(mercury({"new", "voxel", "-o", path("one.json")}));
  const std::string text = read(run("moved", {path("one.json")}));
  write("moved.json", with(text, path("one.json"), "one.json"));
  const Outcome outcome = succeeded(film({"moved.json", "--still", "0.2"}, "one.png"));
  EXPECT_THAT(outcome.messages, HasSubstr("bit for bit"));
  write("gone.json", with(text, path("one.json"), "gone/one.json"));
  EXPECT_THAT(film({"gone.json"}, "gone.mp4"),
              Ends(2, HasSubstr("gone.json: /robots/0/file: gone/one.json is not there; a result names its robots")));
}

TEST_F(RenderResult, ThatEndsElsewhereIsFilmedAndSaidSo) {
  const std::string text = read(run("walk", {"--random", "voxel:1"}));
  const std::size_t hash = text.find("\"hash\": \"") + 9;
  std::string other = text;
  other[hash] = other[hash] == '0' ? '1' : '0';
  write("other.json", other);
  const Outcome outcome = film({"other.json", "--still", "0.2"}, "other.png");
  EXPECT_EQ(outcome.status, 1);
  EXPECT_THAT(outcome.messages, HasSubstr("1 of 1 robots end elsewhere than in the result"));
  EXPECT_EQ(render::read_png(path("other.png")).width, 240);

  write("trials.json", with(text, "\"trials\": 1", "\"trials\": 3"));
  const Outcome trials = succeeded(film({"trials.json", "--still", "0.2"}, "trials.png"));
  EXPECT_THAT(trials.messages,
              HasSubstr("3 trials with jitter 0; here robots begin without jitter, and are not compared"));
}

TEST_F(RenderResult, OfRandomRobotsNeedsTheOptionsOfTheirKind) {
  const std::string result = run("wide", {"--random", "voxel:1", "--voxels", "3x2x2"});
  EXPECT_THAT(film({result}, "without.mp4"), Ends(2, HasSubstr("give the options of its kind that made it")));
  EXPECT_EQ(film({result, "--voxels", "3x2x2", "--still", "0"}, "with.png").status, 0);
}

TEST_F(RenderResult, ThatCannotBeUsedIsRefusedInOneLine) {
  const std::string result = run("walk", {"--random", "voxel:1"});
  const std::string text = read(result);
  const auto refused = [&](const std::string& name, const std::string& content, const std::string& message) {
    write(name, content);
    EXPECT_THAT(film({name}, "a.mp4"), Ends(2, HasSubstr(name + ": " + message))) << name;
  };
  refused("cut.json", text.substr(0, text.size() / 2), "is not a result of mercury run --json");
  refused("empty.json", with(text, "\"masses\":", "\"no_masses\":"), "/robots: names no robot that was stepped");
  refused("many.json", with(text, "\"steps\": ", "\"steps\": -"), "/steps: give a whole number of 0 or more");
  refused("hash.json", with(text, "\"hash\": \"", "\"hash\": \"x"), "/robots/0/hash: \"x");
  refused("both.json", with(text, "\"random\": \"", "\"file\": \"a.json\", \"random\": \""), "/robots/0: give either");
  EXPECT_THAT(film({result, "--random", "voxel:1"}, "a.mp4").messages,
              HasSubstr("walk.json: a result stands beside recordings, results and runs"));
  EXPECT_THAT(mercury({"run", path(result)}),
              Ends(2, HasSubstr("walk.json: is a result of mercury run; mercury render films it")));
}

}  // namespace
}  // namespace mercury::test
