// SPDX-License-Identifier: Apache-2.0
// mercury render: makes short videos and checks the files.
#include <gmock/gmock.h>
#include <signal.h>
#include <sys/stat.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <iterator>
#include <set>

#include "render/png.h"
#include "tests/app/program.h"
#include "tests/nap.h"

namespace mercury::test {
namespace {

using testing::HasSubstr;

class RenderCommand : public FolderTest {
 protected:
  std::vector<std::string> command(const std::string& output, std::vector<std::string> more = {}) const {
    return joined({"render", "--random", "voxel:2", "--size", "160x90", "--faceted", "-o", path(output)}, more);
  }
};

TEST_F(RenderCommand, VideoHasTheRequestedFrames) {
  const Outcome outcome = succeeded(mercury(command("a.mp4", {"--fps", "20", "--seconds", "0.5"})));
  const auto stream = probe(path("a.mp4"));
  EXPECT_EQ(stream["width"], 160);
  EXPECT_EQ(stream["height"], 90);
  EXPECT_EQ(stream["nb_read_frames"], "10");
  EXPECT_EQ(stream["r_frame_rate"], "20/1");
  EXPECT_EQ(outcome.output, "");
  // The messages name the device, OpenGL and the encoder.
  EXPECT_THAT(outcome.messages, HasSubstr("simulating 2 robots (ocean) on "));
  EXPECT_THAT(outcome.messages, HasSubstr("drawing with "));
  EXPECT_THAT(outcome.messages, HasSubstr("encoding H.264 by ffmpeg"));
  EXPECT_EQ(listing(), std::vector<std::string>{"a.mp4"});
}

TEST_F(RenderCommand, HeroShowsOneRobotAndCopiesBehindIt) {
  const Outcome outcome =
      succeeded(mercury(command("hero.png", {"--style", "hero", "--quality", "low", "--still", "0.1"})));
  EXPECT_THAT(outcome.messages, HasSubstr("simulating 10 robots (ocean) on "));
  EXPECT_EQ(render::read_png(path("hero.png")).width, 160);
}

TEST_F(RenderCommand, FootprintsOfAStillAreThoseOfTheFilm) {
  const auto drawn = [&](const std::string& output, std::vector<std::string> more) {
    succeeded(mercury(joined(
        {"render", "sample:dog", "--size", "160x90", "--quality", "medium", "--camera", "still", "-o", path(output)},
        more)));
    return output.ends_with("/") ? render::Image{} : render::read_png(path(output));
  };
  // Frames at other times than those at which the ground is looked at.
  drawn("slow/", {"--seconds", "2.7", "--fps", "1.15"});
  drawn("fast/", {"--seconds", "2.7", "--fps", "2.3"});
  const render::Image slow = render::read_png(path("slow/frame-00002.png"));
  EXPECT_EQ(slow.bytes, render::read_png(path("fast/frame-00004.png")).bytes);
  const render::Image still = drawn("a.png", {"--still", "1.3"});
  EXPECT_NE(still.bytes, drawn("c.png", {"--still", "1.3", "--no-footprints"}).bytes);
}

TEST_F(RenderCommand, ALensIsOfAPicture) {
  for (const Arguments& options :
       {std::vector<std::string>{"--style", "hero"}, std::vector<std::string>{"--aperture", "0.1"}}) {
    const Outcome outcome = mercury(command("a.mp4", options));
    EXPECT_EQ(outcome.status, 2);
    EXPECT_THAT(outcome.messages, HasSubstr(options[0] + ": "));
    EXPECT_THAT(outcome.messages, HasSubstr("give --still, or -o FILE.png"));
  }
  EXPECT_EQ(mercury(command("a.png", {"--still", "0", "--aperture", "2"})).status, 2);
  EXPECT_EQ(mercury(command("b.png", {"--still", "0", "--style", "hero", "--compare", "solver=xpbd"})).status, 2);
}

TEST_F(RenderCommand, SpeedShortensTheVideo) {
  succeeded(mercury(command("a.mp4", {"--fps", "20", "--seconds", "1", "--speed", "4"})));
  EXPECT_EQ(probe(path("a.mp4"))["nb_read_frames"], "5");
}

TEST_F(RenderCommand, QuietPrintsNothing) {
  const Outcome outcome = succeeded(mercury(command("a.gif", {"--fps", "20", "--seconds", "0.1", "--quiet"})));
  EXPECT_EQ(outcome.messages, "");
  EXPECT_EQ(probe(path("a.gif"))["nb_read_frames"], "2");
}

TEST_F(RenderCommand, OddSizesAreRoundedUpAndReported) {
  const Outcome outcome = succeeded(mercury(command("a.webm", {"--seconds", "0.1", "--size", "161x91"})));
  EXPECT_THAT(outcome.messages, HasSubstr("needs even sides: drawn at 162x92"));
  EXPECT_EQ(probe(path("a.webm"))["width"], 162);
}

TEST_F(RenderCommand, FramesOfAFolderShowMovingRobots) {
  succeeded(mercury(command("frames", {"--fps", "1", "--seconds", "2"})));
  ASSERT_EQ(listing("frames"), (std::vector<std::string>{"frame-00000.png", "frame-00001.png"}));
  EXPECT_NE(read("frames/frame-00000.png"), read("frames/frame-00001.png"));
}

TEST_F(RenderCommand, SameCommandGivesTheSamePictures) {
  succeeded(mercury(command("a", {"--fps", "2", "--seconds", "1", "--environment", "land"})));
  succeeded(mercury(command("b", {"--fps", "2", "--seconds", "1", "--environment", "land", "--threads", "1"})));
  for (const std::string& frame : listing("a")) EXPECT_EQ(read("a/" + frame), read("b/" + frame)) << frame;
}

TEST_F(RenderCommand, StillShowsTheGivenTime) {
  succeeded(mercury(command("a.png", {"--still", "1"})));
  succeeded(mercury(command("frames", {"--fps", "1", "--seconds", "2"})));
  const render::Image still = render::read_png(path("a.png")), frame = render::read_png(path("frames/frame-00001.png"));
  EXPECT_EQ(still.width, 160);
  EXPECT_EQ(still.height, 90);
  // The camera of the video lags a little behind, so the pictures are similar but not equal.
  double difference = 0;
  for (std::size_t i = 0; i < still.bytes.size(); ++i) difference += std::abs(still.bytes[i] - frame.bytes[i]);
  EXPECT_LT(difference / static_cast<double>(still.bytes.size()), 8);
}

// On land, so that there is a shadow.
TEST_F(RenderCommand, FiguresShowRobotsAndTheirShadowsAlone) {
  const std::vector<std::string> figure{"--background", "transparent", "--environment", "land", "--show", "skin"};
  succeeded(mercury(command("a.png", figure)));
  const render::Image image = render::read_png(path("a.png"));
  ASSERT_EQ(image.format, render::PixelFormat::rgba);
  ASSERT_EQ(image.width, 160);
  int nothing = 0, solid = 0, shadow = 0;
  for (std::size_t i = 0; i + 3 < image.bytes.size(); i += 4) {
    const std::uint8_t opacity = image.bytes[i + 3];
    nothing += opacity == 0;
    solid += opacity == 255;
    shadow += opacity > 30 && opacity < 200 && image.bytes[i] < 20;
  }
  EXPECT_GT(nothing, 160 * 90 / 4);
  EXPECT_GT(solid, 160 * 90 / 50);
  EXPECT_GT(shadow, 50);
  const Arguments tight = joined(figure, {"--tight", "--dpi", "300"});
  succeeded(mercury(command("b.png", tight)));
  EXPECT_LT(render::read_png(path("b.png")).width, 160);
  EXPECT_NE(read("b.png").find("pHYs"), std::string::npos);
  succeeded(mercury(command("c.png", {"--background", "white", "--show", "skin"})));
  const render::Image white = render::read_png(path("c.png"));
  EXPECT_EQ(white.format, render::PixelFormat::rgb);
  EXPECT_TRUE(std::all_of(white.bytes.begin(), white.bytes.begin() + 9, [](int byte) { return byte == 255; }));
  succeeded(mercury(command("d.svg", {"--background", "white", "--caption", "Fig. 1", "--scale-bar"})));
  EXPECT_THAT(read("d.svg"), HasSubstr(">Fig. 1</text>"));
  succeeded(mercury(command("d.pdf", {"--background", "transparent", "--caption", "Fig. 1"})));
  EXPECT_TRUE(read("d.pdf").starts_with("%PDF-"));
  EXPECT_THAT(mercury(command("e.mp4", {"--background", "transparent", "--seconds", "0.1"})).messages,
              HasSubstr("--background: .mp4 has no transparency"));
  EXPECT_THAT(mercury(command("e.pdf", {"--still", "0"})).messages, HasSubstr("give --background"));
  EXPECT_THAT(mercury(command("e.png", {"--tight", "--still", "0"})).messages, HasSubstr("--tight: cuts a figure off"));
  EXPECT_THAT(
      mercury(command("e.png", {"--background", "mauve"})).messages,
      HasSubstr("--background: \"mauve\" is not accepted; give white, black, transparent or a color as #2a6f97"));
}

// What ffmpeg reads of a film: the frames, 4 bytes per pixel.
std::string decoded(const std::string& film, const std::string& decoder = {}) {
  std::vector<std::string> arguments{"-loglevel", "error"};
  if (!decoder.empty()) arguments.insert(arguments.end(), {"-c:v", decoder});
  ChildProcess child("ffmpeg", joined(arguments, {"-i", film, "-vsync", "passthrough", "-f", "rawvideo", "-pix_fmt",
                                                  "rgba", "-y", film + ".raw"}));
  EXPECT_EQ(outcome_of(child).status, 0);
  std::ifstream frames(film + ".raw", std::ios::binary);
  return {std::istreambuf_iterator<char>(frames), {}};
}

TEST_F(RenderCommand, FilmsOverNothingHaveOpacities) {
  const std::vector<std::string> figure{"--background", "transparent", "--seconds", "0.1",
                                        "--fps",        "20",          "--show",    "skin"};
  constexpr std::size_t frame = 160 * 90 * 4;
  succeeded(mercury(command("frames", figure)));
  const render::Image still = render::read_png(path("frames/frame-00001.png"));
  ASSERT_EQ(still.format, render::PixelFormat::rgba);
  for (const std::string name : {"a.webm", "a.gif", "a.apng"}) {
    succeeded(mercury(command(name, figure)));
    const std::string frames = decoded(path(name), name == "a.webm" ? "libvpx-vp9" : "");
    ASSERT_EQ(frames.size(), 2 * frame) << name;
    double difference = 0;
    for (std::size_t i = 3; i < frame; i += 4)
      difference += std::abs(static_cast<std::uint8_t>(frames[frame + i]) - still.bytes[i]);
    EXPECT_LT(difference / (160 * 90), name == "a.apng" ? 1e-9 : 8) << name;
  }
  succeeded(mercury(command("a.mp4", {"--background", "white", "--seconds", "0.1", "--fps", "20", "--show", "skin"})));
  const std::string white = decoded(path("a.mp4"));
  ASSERT_EQ(white.size(), 2 * frame);
  for (std::size_t i = 0; i < 3; ++i) EXPECT_GE(static_cast<std::uint8_t>(white[i]), 253);
}

TEST_F(RenderCommand, ContactSheetHasTheRequestedWidth) {
  succeeded(mercury(command("a.png", {"--contact-sheet", "3x2", "--seconds", "0.5", "--size", "400x200"})));
  const render::Image sheet = render::read_png(path("a.png"));
  // Three pictures and two gaps of 4 pixels: (400 + 4) / 3 - 4 = 130 wide, half as high.
  EXPECT_EQ(sheet.width, 3 * 130 + 2 * 4);
  EXPECT_EQ(sheet.height, 2 * 65 + 4);
}

TEST_F(RenderCommand, RecordingGivesThePicturesOfTheSimulation) {
  const std::vector<std::string> simulate{"--random",      "voxel:2", "--seconds", "1",
                                          "--environment", "land",    "--dt",      "0.002"};
  succeeded(mercury(joined({"run", "--record", path("a.h5"), "--every", "1"}, simulate)));
  succeeded(mercury({"render", path("a.h5"), "-o", path("played"), "--fps", "2", "--size", "160x90"}));
  const Arguments direct = joined({"render", "-o", path("direct"), "--fps", "2", "--size", "160x90"}, simulate);
  succeeded(mercury(direct));
  EXPECT_EQ(listing("played"), (std::vector<std::string>{"frame-00000.png", "frame-00001.png"}));
  for (const std::string& frame : listing("direct"))
    EXPECT_EQ(read("direct/" + frame), read("played/" + frame)) << frame;
}

TEST_F(RenderCommand, RobotsBeginWhereTheFirstTrialOfARunDoes) {
  const Arguments robots{"--random", "voxel:2", "--seconds", "0.5", "--seed", "3", "--dt", "0.002"};
  const std::vector<std::string> start{"--target", "0.3,0.2,0", "--target-radius", "0.6", "--turned"};
  const auto made = [&](std::vector<std::string> words, const Arguments& more) {
    for (const auto* part : {&robots, &more}) words.insert(words.end(), part->begin(), part->end());
    succeeded(mercury(words));
  };
  const auto picture = [&](const std::string& name) {
    return std::vector<std::string>{"render", "-o", path(name), "--fps", "2", "--size", "160x90"};
  };
  made({"run", "--record", path("a.h5"), "--every", "1"}, start);
  succeeded(mercury({"render", path("a.h5"), "-o", path("played"), "--fps", "2", "--size", "160x90"}));
  made(picture("direct"), start);
  made(picture("elsewhere"), {"--target", "0.3,0.2,0"});
  EXPECT_EQ(read("direct/frame-00000.png"), read("played/frame-00000.png"));
  EXPECT_NE(read("direct/frame-00000.png"), read("elsewhere/frame-00000.png"));
  EXPECT_THAT(mercury({"render", path("a.h5"), "--target-radius", "1", "-o", path("b")}),
              Ends(2, "--target-radius: a recording has its own start; give robots to simulate"));
}

// Steps of 1 ms do not fit into 30 frames/s: film, recording and the film of the recording show the same moments.
TEST_F(RenderCommand, FilmsAndRecordingsHaveExactlyTheirRate) {
  const std::vector<std::string> simulate{"--random", "voxel:1", "--seconds", "1", "--device", "cpu"};
  const auto with = [&](const Arguments& command) { return mercury(joined(command, simulate)).status; };
  ASSERT_EQ(with({"run", "--record", path("a.h5"), "--fps", "30"}), 0);
  const auto film_of = [&](const std::string& name) {
    return std::vector<std::string>{"render", "-o", path(name), "--size", "64x36", "--quality", "low", "--faceted"};
  };
  ASSERT_EQ(with(film_of("a.mp4")), 0);
  succeeded(mercury(joined(film_of("b.mp4"), {path("a.h5")})));
  for (const char* film : {"a.mp4", "b.mp4"}) {
    const auto stream = probe(path(film));
    EXPECT_EQ(stream["r_frame_rate"], "30/1");
    EXPECT_EQ(stream["nb_read_frames"], "30");
    EXPECT_NEAR(std::stod(stream["duration"].get<std::string>()), 1, 1e-6);
  }
  const std::vector<std::string> short_film{"--size",  "160x90", "--seconds", "0.2",
                                            "--theme", "light",  "--quality", "low"};
  std::vector<std::string> played{"render", path("a.h5"), "-o", path("played")},
      direct{"render", "--random", "voxel:1", "--device", "cpu", "-o", path("direct")};
  for (auto* command : {&played, &direct}) {
    command->insert(command->end(), short_film.begin(), short_film.end());
    succeeded(mercury(*command));
  }
  ASSERT_EQ(listing("direct").size(), 6u);
  for (const std::string& frame : listing("direct")) {
    const render::Image a = render::read_png(path("played/" + frame)), b = render::read_png(path("direct/" + frame));
    int farthest = 0;
    for (std::size_t i = 0; i < a.bytes.size(); ++i) farthest = std::max(farthest, std::abs(a.bytes[i] - b.bytes[i]));
    EXPECT_LE(farthest, 2) << frame;  // positions are rounded differently
  }
}

TEST_F(RenderCommand, RecordingDoesNotMixWithRobots) {
  write("a.h5", "");
  EXPECT_THAT(mercury(command("a.mp4", {path("a.h5")})),
              Ends(2, path("a.h5") + ": a recording is played alone; give it without other robots"));
}

TEST_F(RenderCommand, EachRobotGetsAVideo) {
  succeeded(mercury(command("a.gif", {"--each", "--seconds", "0.1", "--seed", "3"})));
  EXPECT_EQ(listing(), (std::vector<std::string>{"a-voxel-3-0.gif", "a-voxel-3-1.gif"}));
}

// A name with a dot is no file type.
TEST_F(RenderCommand, VideosOfRobotsWithDotsInTheirNamesKeepTheirType) {
  write("r.json", R"({"format": "mercury-robot", "version": 1, "name": "v1.2",
    "masses": [[0,0,0],[1,0,0]], "springs": [[0,1,1]], "faces": []})");
  for (const auto& [output, written] : std::vector<std::pair<std::string, std::string>>{
           {"a.mp4", "a-v1.2.mp4"}, {"b.1.gif", "b.1-v1.2.gif"}, {"frames/", "frames-v1.2/"}}) {
    const Outcome outcome = succeeded(mercury({"render", path("r.json"), "--each", "-o", path(output), "--dry-run"}));
    EXPECT_THAT(outcome.output, HasSubstr(path(written) + "\n"));
  }
}

// Each view option changes the picture and is drawn without an error.
TEST_F(RenderCommand, ViewOptionsChangeThePicture) {
  const std::vector<std::vector<std::string>> variants{{},
                                                       {"--color", "strain"},
                                                       {"--color", "pressure"},
                                                       {"--show", "springs,masses"},
                                                       {"--show", "skin,drag,lift,velocity"},
                                                       {"--show", "skin,path,labels,legend,clock,scale"},
                                                       {"--theme", "light"},
                                                       {"--plain"},
                                                       {"--cut", "y:0"},
                                                       {"--layout", "race"},
                                                       {"--camera", "top"},
                                                       {"--follow", "--azimuth", "30"}};
  std::set<std::string> pictures;
  for (const Arguments& variant : variants) {
    succeeded(mercury(command("a.png", joined({"--still", "0.5", "--force"}, variant))));
    EXPECT_TRUE(pictures.insert(read("a.png")).second) << testing::PrintToString(variant);
  }
}

TEST_F(RenderCommand, DyingEncoderEndsTheProgramWithOneLine) {
  write("dying", "#!/bin/sh\necho 'out of ink' >&2\nexit 4\n", true);
  EXPECT_THAT(mercury(command("a.mp4", {"--quiet", "--seconds", "1", "--ffmpeg", path("dying")})),
              Ends(1, path("a.mp4") + ": the encoder " + path("dying") + " ended with status 4: out of ink"));
  EXPECT_EQ(listing(), std::vector<std::string>{"dying"});
}

TEST_F(RenderCommand, MissingEncoderIsReportedBeforeDrawing) {
  EXPECT_THAT(run_program("sh", {"-c", "PATH=/nowhere exec \"$0\" render --random voxel -o \"$1\"", MERCURY_PROGRAM,
                                 path("a.mp4")}),
              Ends(1,
                   "ffmpeg was not found: install the package ffmpeg (apt install ffmpeg), name the program with "
                   "--ffmpeg, or write PNG pictures into a folder (-o FOLDER)"));
  EXPECT_EQ(listing(), std::vector<std::string>{});
}

TEST_F(RenderCommand, FileBeyondTheSizeLimitIsReported) {
  EXPECT_THAT(
      run_program(
          "sh", {"-c", "ulimit -f 1; exec \"$0\" render --random voxel:2 --size 160x90 --seconds 0.2 --quiet -o \"$1\"",
                 MERCURY_PROGRAM, path("a.mp4")}),
      Ends(1, path("a.mp4") + ": the file grew beyond the size allowed here (ulimit -f); nothing was kept"));
  EXPECT_EQ(listing(), std::vector<std::string>{});
}

// A very long video, interrupted once the encoder has begun to write.
class InterruptedVideo : public RenderCommand {
 protected:
  std::unique_ptr<ChildProcess> begin() {
    auto child = std::make_unique<ChildProcess>(MERCURY_PROGRAM, command("a.mp4", {"--seconds", "100000"}));
    while (!writing()) nap();
    return child;
  }

  bool writing() const {
    for (const auto& entry : std::filesystem::directory_iterator(folder_)) {
      std::error_code gone;
      if (entry.file_size(gone) > 0 && !gone) return true;
    }
    return false;
  }
};

TEST_F(InterruptedVideo, LeavesAPlayableVideo) {
  for (const int signal : {SIGINT, SIGTERM}) {
    const auto child = begin();
    child->signal(signal);
    const Outcome outcome = outcome_of(*child);
    EXPECT_EQ(outcome.status, 128 + signal);
    EXPECT_THAT(outcome.messages, HasSubstr("stopped early"));
    EXPECT_EQ(listing(), std::vector<std::string>{"a.mp4"});
    EXPECT_GE(std::stoi(probe(path("a.mp4")).value("nb_read_frames", "0")), 1);
    std::filesystem::remove(path("a.mp4"));
  }
}

// An encoder that neither reads nor obeys keeps the program waiting.
TEST_F(InterruptedVideo, SecondInterruptEndsAtOnceWithTheEncoderAndLeavesNoFile) {
  ASSERT_EQ(mkfifo(path("life").c_str(), 0600), 0);
  // The script and its child hold the pipe open for as long as they live.
  write("stuck", "#!/bin/sh\nexec 9>" + path("life") + "\ntrap '' TERM INT HUP PIPE\nwhile :; do sleep 1000; done\n",
        true);
  ChildProcess child(MERCURY_PROGRAM, command("b.mp4", {"--seconds", "100000", "--ffmpeg", path("stuck")}));
  std::ifstream life(path("life"));  // waits until the script has opened it
  while (child.messages().find("encoding") == std::string::npos) nap();
  child.signal(SIGINT);
  while (listing().size() > 2) {  // until the program has handled both signals
    child.signal(SIGINT);
    nap();
  }
  EXPECT_EQ(outcome_of(child).status, 128 + SIGINT);
  EXPECT_EQ(life.get(), std::ifstream::traits_type::eof());  // waits until nobody holds it any more
  EXPECT_EQ(listing(), (std::vector<std::string>{"life", "stuck"}));
}

// --- What is not replaced, and what is not accepted

class RefusedVideo : public RenderCommand {
 protected:
  // The one line of a command that would run for days.
  std::string refusal(const std::string& output, std::vector<std::string> more) const {
    if (std::find(more.begin(), more.end(), "--seconds") == more.end()) more.insert(more.end(), {"--seconds", "10000"});
    const Outcome outcome = mercury(command(output, more));
    EXPECT_EQ(outcome.status, 2) << testing::PrintToString(more) << outcome.messages;
    EXPECT_EQ(std::count(outcome.messages.begin(), outcome.messages.end(), '\n'), 1) << outcome.messages;
    return outcome.messages;
  }
};

TEST_F(RefusedVideo, FolderThatHoldsSomethingIsFilledOnlyWithForce) {
  const std::vector<std::string> longer{"--fps", "1", "--seconds", "3"}, shorter{"--fps", "1", "--seconds", "1"};
  succeeded(mercury(command("frames", longer)));
  const std::string last = read("frames/frame-00002.png");
  EXPECT_EQ(refusal("frames", {}),
            "mercury: -o: " + path("frames") + " is not empty; use --force to write into it, or give another folder\n");
  EXPECT_EQ(read("frames/frame-00002.png"), last);
  for (const char* name : {"frames/note", "frames/frame-1.png", "frames/frame-00007.jpg"}) write(name, "mine");
  write("frames/frame-00005.png", "of an earlier film, after a gap");
  succeeded(mercury(command("frames", joined(shorter, {"--force"}))));
  EXPECT_EQ(listing("frames"), (std::vector<std::string>{"frame-00000.png", "frame-00007.jpg", "frame-1.png", "note"}));
}

TEST_F(RefusedVideo, FolderThatAnotherProcessFillsIsRefused) {
  ChildProcess first(MERCURY_PROGRAM, command("frames", {"--seconds", "100000", "--fps", "1000"}));
  while (!std::filesystem::exists(path("frames")) || listing("frames").empty()) nap();
  EXPECT_EQ(refusal("frames", {"--force"}),
            "mercury: -o: " + path("frames") + " is being filled by another process; give another folder\n");
  first.kill();
  // A process that was killed holds nothing any more.
  EXPECT_EQ(mercury(command("frames", {"--fps", "1", "--seconds", "1", "--force"})).status, 0);
}

TEST_F(RefusedVideo, NumbersThatCannotBeUsedAreReportedBeforeAnyWork) {
  const std::vector<std::pair<std::vector<std::string>, std::string>> cases{
      {{"--fps", "1e-30"}, "--fps: 1e-30 is not accepted; give 0.001 to 1000 frames/s"},
      {{"--fps", "nan"}, "--fps: nan is not accepted"},
      {{"--fps", "inf"}, "--fps: inf is not accepted"},
      {{"--fps", "-1"}, "--fps: -1 is not accepted"},
      {{"--fps", "1001"}, "--fps: 1001 is not accepted"},
      {{"--speed", "nan"}, "--speed: nan is not accepted; give 1e-06 to 1000000"},
      {{"--speed", "1e-300"}, "--speed: 1e-300 is not accepted"},
      {{"--speed", "1e300"}, "--speed: 1e+300 is not accepted"},
      {{"--speed", "0"}, "--speed: 0 is not accepted"},
      {{"--seconds", "1e300"}, "--seconds: "},
      {{"--seconds", "nan"}, "--seconds: nan is not accepted"},
      {{"--seconds", "1e8", "--fps", "1000"}, "--seconds: 1e+11 frames are too many for a video"},
      {{"--crf", "52"}, "--crf: 52 is not accepted; give 0 to 51 for .mp4"},
      {{"--crf", "-1"}, "--crf: -1 is not accepted; give 0 to 51 for .mp4"},
      {{"--size", "16385x1"}, "--size: 16385x1 is not accepted; give WIDTHxHEIGHT from 1x1 to 16384x16384"},
      {{"--size", "1x16385"}, "--size: 1x16385 is not accepted"},
      {{"--size", "2147483648x1"}, "--size: \"2147483648x1\" is not accepted"},
      {{"--cut", "y:nan"}, "--cut: \"y:nan\" is not accepted"},
      {{"--cut", "y:inf"}, "--cut: \"y:inf\" is not accepted"},
      {{"--cut", "y:1e30"}, "--cut: \"y:1e30\" is not accepted"},
      {{"--cut", "y:"}, "--cut: \"y:\" is not accepted"},
      {{"--scale", "nan,1"}, "--scale: "},
      {{"--scale", "-3e38,3e38"}, "--scale: "},
      {{"--azimuth", "nan"}, "--azimuth: "},
      {{"--elevation", "inf"}, "--elevation: "},
      {{"--zoom", "1e30"}, "--zoom: 1e+30 is not accepted; give 0.001 to 1000"},
      {{"--zoom", "nan"}, "--zoom: nan is not accepted"},
      {{"--grid", "1000000000x2"}, "--grid: 1000000000x2 is not accepted; give 1 to 10000 columns and rows"},
      {{"--still", "nan"}, "--still: nan is not accepted"},
      {{"--still", "1e300"}, "--still: 1e+300 s are too many steps of 0.001 s"},
      {{"--still", "-1"}, "--still: -1 is not accepted"},
      {{"--contact-sheet", "5x2000000000"}, "--contact-sheet: 5x2000000000 is not accepted; give up to 1000 columns"},
      {{"--contact-sheet", "1000x1"}, "--contact-sheet: the moments are too small to be drawn"},
      {{"--contact-sheet", "1x1000"}, "--size: the picture would be 160x93996; give a size that leads to"}};
  for (const auto& [options, message] : cases) {
    const bool picture = options[0] == "--still" || options[0] == "--contact-sheet";
    EXPECT_THAT(refusal(picture ? "a.png" : "a.mp4", options), testing::StartsWith("mercury: " + message));
  }
  EXPECT_EQ(refusal("a.webm", {"--crf", "64"}), "mercury: --crf: 64 is not accepted; give 0 to 63 for .webm\n");
  EXPECT_EQ(refusal("a.gif", {"--crf", "20"}), "mercury: --crf: .gif has no such quality; leave it out\n");
  EXPECT_EQ(refusal("frames/", {"--crf", "20"}),
            "mercury: --crf: a folder of PNG pictures has no such quality; leave it out\n");
  EXPECT_EQ(refusal("a.gif", {"--fps", "51"}),
            "mercury: --fps: a GIF shows at most 50 frames/s; give 50 or less, or another format\n");
  EXPECT_EQ(refusal("a.mp4", {"--still", "1"}),
            "mercury: -o: " + path("a.mp4") + ": a picture is written as .png; give such a name\n");
  EXPECT_EQ(listing(), std::vector<std::string>{});
}

TEST_F(RefusedVideo, WhatARecordingDoesNotHaveIsRefused) {
  succeeded(mercury({"run", "--random", "voxel:1", "--seconds", "0.5", "--record", path("a.h5")}));
  const auto still = [&](const std::string& moment, const std::string& name) {
    return mercury({"render", path("a.h5"), "--still", moment, "--size", "160x90", "-o", path(name)});
  };
  EXPECT_THAT(still("0.6", "b.png"), Ends(2, "--still: 0.6 is not accepted; the recording has 0 to 0.495 s"));
  EXPECT_EQ(still("0.5", "end.png").status, 0);
  EXPECT_THAT(mercury({"render", path("a.h5"), "--compare", "solver=xpbd", "-o", path("c.mp4")}),
              Ends(2, "--compare: not together with a recording, which has one side; give its robots' files"));
  EXPECT_EQ(listing(), (std::vector<std::string>{"a.h5", "end.png"}));
}

}  // namespace
}  // namespace mercury::test
