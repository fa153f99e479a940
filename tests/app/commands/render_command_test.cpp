// SPDX-License-Identifier: Apache-2.0
// mercury render: makes short videos and checks the files.
#include <gmock/gmock.h>
#include <signal.h>

#include <cmath>
#include <set>

#include "render/png.h"
#include "tests/app/program.h"

namespace mercury::test {
namespace {

using testing::HasSubstr;

class RenderCommand : public FolderTest {
 protected:
  std::vector<std::string> command(const std::string& output, std::vector<std::string> more = {}) const {
    std::vector<std::string> arguments{"render", "--random", "voxel:2", "--size", "160x90", "-o", path(output)};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return arguments;
  }
};

TEST_F(RenderCommand, VideoHasTheRequestedFrames) {
  const Outcome outcome = mercury(command("a.mp4", {"--fps", "20", "--seconds", "0.5"}));
  ASSERT_EQ(outcome.status, 0) << outcome.messages;
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

TEST_F(RenderCommand, SpeedShortensTheVideo) {
  ASSERT_EQ(mercury(command("a.mp4", {"--fps", "20", "--seconds", "1", "--speed", "4"})).status, 0);
  EXPECT_EQ(probe(path("a.mp4"))["nb_read_frames"], "5");
}

TEST_F(RenderCommand, QuietPrintsNothing) {
  const Outcome outcome = mercury(command("a.gif", {"--fps", "20", "--seconds", "0.1", "--quiet"}));
  EXPECT_EQ(outcome.status, 0);
  EXPECT_EQ(outcome.messages, "");
  EXPECT_EQ(probe(path("a.gif"))["nb_read_frames"], "2");
}

TEST_F(RenderCommand, OddSizesAreRoundedUpAndReported) {
  const Outcome outcome = mercury(command("a.webm", {"--seconds", "0.1", "--size", "161x91"}));
  ASSERT_EQ(outcome.status, 0) << outcome.messages;
  EXPECT_THAT(outcome.messages, HasSubstr("needs even sides: drawn at 162x92"));
  EXPECT_EQ(probe(path("a.webm"))["width"], 162);
}

TEST_F(RenderCommand, FramesOfAFolderShowMovingRobots) {
  ASSERT_EQ(mercury(command("frames", {"--fps", "1", "--seconds", "2"})).status, 0);
  ASSERT_EQ(listing("frames"), (std::vector<std::string>{"frame-00000.png", "frame-00001.png"}));
  EXPECT_NE(read("frames/frame-00000.png"), read("frames/frame-00001.png"));
}

TEST_F(RenderCommand, SameCommandGivesTheSamePictures) {
  ASSERT_EQ(mercury(command("a", {"--fps", "2", "--seconds", "1", "--environment", "land"})).status, 0);
  ASSERT_EQ(mercury(command("b", {"--fps", "2", "--seconds", "1", "--environment", "land", "--threads", "1"})).status,
            0);
  for (const std::string& frame : listing("a")) EXPECT_EQ(read("a/" + frame), read("b/" + frame)) << frame;
}

TEST_F(RenderCommand, StillShowsTheGivenTime) {
  ASSERT_EQ(mercury(command("a.png", {"--still", "1"})).status, 0);
  ASSERT_EQ(mercury(command("frames", {"--fps", "1", "--seconds", "2"})).status, 0);
  const render::Image still = render::read_png(path("a.png")), frame = render::read_png(path("frames/frame-00001.png"));
  EXPECT_EQ(still.width, 160);
  EXPECT_EQ(still.height, 90);
  // The camera of the video lags a little behind, so the pictures are similar but not equal.
  double difference = 0;
  for (std::size_t i = 0; i < still.bytes.size(); ++i) difference += std::abs(still.bytes[i] - frame.bytes[i]);
  EXPECT_LT(difference / static_cast<double>(still.bytes.size()), 8);
}

TEST_F(RenderCommand, ContactSheetHasTheRequestedWidth) {
  ASSERT_EQ(mercury(command("a.png", {"--contact-sheet", "3x2", "--seconds", "0.5", "--size", "400x200"})).status, 0);
  const render::Image sheet = render::read_png(path("a.png"));
  // Three pictures and two gaps of 4 pixels: (400 + 4) / 3 - 4 = 130 wide, half as high.
  EXPECT_EQ(sheet.width, 3 * 130 + 2 * 4);
  EXPECT_EQ(sheet.height, 2 * 65 + 4);
}

TEST_F(RenderCommand, RecordingGivesThePicturesOfTheSimulation) {
  const std::vector<std::string> simulate{"--random",      "voxel:2", "--seconds", "1",
                                          "--environment", "land",    "--dt",      "0.002"};
  std::vector<std::string> record{"run", "--record", path("a.h5"), "--every", "1"};
  record.insert(record.end(), simulate.begin(), simulate.end());
  ASSERT_EQ(mercury(record).status, 0);
  ASSERT_EQ(mercury({"render", path("a.h5"), "-o", path("played"), "--fps", "2", "--size", "160x90"}).status, 0);
  std::vector<std::string> direct{"render", "-o", path("direct"), "--fps", "2", "--size", "160x90"};
  direct.insert(direct.end(), simulate.begin(), simulate.end());
  ASSERT_EQ(mercury(direct).status, 0);
  EXPECT_EQ(listing("played"), (std::vector<std::string>{"frame-00000.png", "frame-00001.png"}));
  for (const std::string& frame : listing("direct"))
    EXPECT_EQ(read("direct/" + frame), read("played/" + frame)) << frame;
}

TEST_F(RenderCommand, RecordingDoesNotMixWithRobots) {
  write("a.h5", "");
  const Outcome outcome = mercury(command("a.mp4", {path("a.h5")}));
  EXPECT_EQ(outcome.status, 2);
  EXPECT_EQ(outcome.messages,
            "mercury: " + path("a.h5") + ": a recording is played alone; give it without other robots\n");
}

TEST_F(RenderCommand, EachRobotGetsAVideo) {
  const Outcome outcome = mercury(command("a.gif", {"--each", "--seconds", "0.1", "--seed", "3"}));
  ASSERT_EQ(outcome.status, 0) << outcome.messages;
  EXPECT_EQ(listing(), (std::vector<std::string>{"a-voxel-3-0.gif", "a-voxel-3-1.gif"}));
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
  for (const std::vector<std::string>& variant : variants) {
    std::vector<std::string> more{"--still", "0.5"};
    more.insert(more.end(), variant.begin(), variant.end());
    const Outcome outcome = mercury(command("a.png", more));
    ASSERT_EQ(outcome.status, 0) << outcome.messages;
    EXPECT_TRUE(pictures.insert(read("a.png")).second) << testing::PrintToString(variant);
  }
}

TEST_F(RenderCommand, DyingEncoderEndsTheProgramWithOneLine) {
  write("dying", "#!/bin/sh\necho 'out of ink' >&2\nexit 4\n", true);
  const Outcome outcome = mercury(command("a.mp4", {"--quiet", "--seconds", "1", "--ffmpeg", path("dying")}));
  EXPECT_EQ(outcome.status, 1);
  EXPECT_EQ(outcome.messages,
            "mercury: " + path("a.mp4") + ": the encoder " + path("dying") + " ended with status 4: out of ink\n");
  EXPECT_EQ(listing(), std::vector<std::string>{"dying"});
}

TEST_F(RenderCommand, MissingEncoderIsReportedBeforeDrawing) {
  const Outcome outcome = run_program(
      "sh", {"-c", "PATH=/nowhere exec \"$0\" render --random voxel -o \"$1\"", MERCURY_PROGRAM, path("a.mp4")});
  EXPECT_EQ(outcome.status, 1);
  EXPECT_EQ(outcome.messages,
            "mercury: ffmpeg was not found: install the package ffmpeg (apt install ffmpeg), name the program with "
            "--ffmpeg, or write PNG pictures into a folder (-o FOLDER)\n");
  EXPECT_EQ(listing(), std::vector<std::string>{});
}

TEST_F(RenderCommand, FileBeyondTheSizeLimitIsReported) {
  const Outcome outcome = run_program(
      "sh", {"-c", "ulimit -f 1; exec \"$0\" render --random voxel:2 --size 320x180 --seconds 1 --quiet -o \"$1\"",
             MERCURY_PROGRAM, path("a.mp4")});
  EXPECT_EQ(outcome.status, 1);
  EXPECT_EQ(outcome.messages, "mercury: " + path("a.mp4") +
                                  ": the file grew beyond the size allowed here (ulimit -f); nothing was kept\n");
  EXPECT_EQ(listing(), std::vector<std::string>{});
}

// A very long video, interrupted once the encoder has begun to write.
class InterruptedVideo : public RenderCommand {
 protected:
  std::unique_ptr<ChildProcess> begin() {
    auto child = std::make_unique<ChildProcess>(MERCURY_PROGRAM, command("a.mp4", {"--seconds", "100000"}));
    while (!writing()) std::this_thread::yield();
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

TEST_F(InterruptedVideo, SecondInterruptEndsAtOnceAndLeavesNoFile) {
  // An encoder that never ends keeps the program waiting.
  write("stuck", "#!/bin/sh\nexec sleep 20\n", true);
  ChildProcess child(MERCURY_PROGRAM, command("b.mp4", {"--seconds", "100000", "--ffmpeg", path("stuck")}));
  while (child.messages().find("encoding") == std::string::npos) std::this_thread::yield();
  child.signal(SIGINT);
  while (listing().size() > 1) {  // until the program has handled both signals
    child.signal(SIGINT);
    std::this_thread::yield();
  }
  EXPECT_EQ(outcome_of(child).status, 128 + SIGINT);
  EXPECT_EQ(listing(), std::vector<std::string>{"stuck"});
}

}  // namespace
}  // namespace mercury::test
