// SPDX-License-Identifier: Apache-2.0
// Videos that the window makes: screen recordings and videos of the group.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "app/live/group_video.h"
#include "app/live/scene_exports.h"
#include "app/live/scene_robots.h"
#include "app/live/scene_time.h"
#include "mercury/robot_file.h"
#include "mercury/voxel.h"
#include "render/png.h"
#include "tests/app/live/live_scene_setup.h"
#include "tests/app/program.h"
#include "tests/nap.h"

namespace mercury {
namespace {

class LiveVideo : public test::FolderTest {};

render::Image plain(int width, int height, std::array<std::uint8_t, 3> color) {
  render::Image image{width, height, render::PixelFormat::rgb, {}};
  for (int i = 0; i < width * height; ++i) image.bytes.insert(image.bytes.end(), color.begin(), color.end());
  return image;
}

template <class Video>
VideoStatus over(const Video& video) {
  while (!video.status().over()) test::nap();
  return video.status();
}

TEST(Yuv420, FollowsBt709InLimitedRange) {
  // Recommendation BT.709 with 8 bits: white is 235, black 16, red is Y 63, Cb 102, Cr 240.
  const auto of = [](std::array<std::uint8_t, 3> color) {
    const render::Image yuv = yuv420_of(plain(3, 3, color));
    EXPECT_EQ(yuv.width, 2);
    EXPECT_EQ(yuv.bytes.size(), 6u);
    return std::array<int, 3>{yuv.bytes[0], yuv.bytes[4], yuv.bytes[5]};
  };
  EXPECT_EQ(of({255, 255, 255}), (std::array{235, 128, 128}));
  EXPECT_EQ(of({0, 0, 0}), (std::array{16, 128, 128}));
  EXPECT_EQ(of({255, 0, 0}), (std::array{63, 102, 240}));
  EXPECT_EQ(of({0, 0, 255}), (std::array{32, 240, 118}));
}

TEST_F(LiveVideo, RecordingRunsInRealTime) {
  const std::string file = path("screen.mp4");
  ScreenRecording recording(file, {65, 49}, 20);
  // Frames at 0 ms, 10 ms (too early), 60 ms and after a pause of a second become the frames 0, 1 and 20 to 21.
  EXPECT_TRUE(recording.offer(5.00, plain(65, 49, {200, 0, 0})));
  EXPECT_FALSE(recording.wants(5.01));
  EXPECT_FALSE(recording.offer(5.01, plain(65, 49, {0, 0, 0})));
  EXPECT_TRUE(recording.wants(5.06));
  EXPECT_TRUE(recording.offer(5.06, plain(65, 49, {0, 200, 0})));
  EXPECT_FALSE(recording.offer(6.0, plain(64, 48, {0, 0, 200}))) << "another size";
  EXPECT_TRUE(recording.offer(6.06, plain(65, 49, {0, 0, 200})));
  recording.finish();
  const VideoStatus status = over(recording);
  ASSERT_EQ(status.state, VideoStatus::State::done) << status.error;
  EXPECT_EQ(status.frames, 22);
  EXPECT_EQ(status.dropped, 0);
  const auto stream = test::probe(file);
  EXPECT_EQ(stream["nb_read_frames"], "22");
  EXPECT_EQ(stream["width"], 64);
  EXPECT_EQ(stream["height"], 48);
}

TEST_F(LiveVideo, FailedRecordingReportsWhyAndCanceledOneLeavesNoFile) {
  ScreenRecording wrong(path("screen.avi"), {64, 48});
  const VideoStatus status = over(wrong);
  EXPECT_EQ(status.state, VideoStatus::State::failed);
  EXPECT_THAT(status.error, testing::HasSubstr(".avi"));
  EXPECT_FALSE(wrong.offer(0, plain(64, 48, {})));
  ScreenRecording canceled(path("screen.mp4"), {64, 48});
  canceled.offer(0, plain(64, 48, {}));
  canceled.cancel();
  EXPECT_EQ(over(canceled).state, VideoStatus::State::canceled);
  EXPECT_TRUE(listing().empty());
}

TEST_F(LiveVideo, GroupVideoIsMadeWhileTheSceneContinues) {
  test::RobotScene scene(2);
  scene.time().step(10);
  const auto video = scene.exports().video({.output = path("group.mp4"),
                                            .size = {160, 90},
                                            .frames_per_second = 10,
                                            .seconds = 0.5,
                                            .quality = render::Quality::low});
  scene.time().play();
  while (!video->status().over()) scene.frame();
  const VideoStatus status = video->status();
  ASSERT_EQ(status.state, VideoStatus::State::done) << status.error;
  EXPECT_EQ(status.frames, 5);
  EXPECT_EQ(status.total, 5);
  EXPECT_EQ(test::probe(path("group.mp4"))["nb_read_frames"], "5");
}

TEST_F(LiveVideo, APictureHasThePixelsOfTheCommands) {
  for (const std::string environment : {"land", "ocean"}) {
    const std::string robot = path(environment + ".json");
    const auto as_command = [&](const std::string& name, const test::Arguments& more) {
      const test::Outcome outcome =
          test::mercury(test::joined({"render", robot, "--environment", environment, "--size", "160x90", "--still",
                                      "0.2", "--quality", "low", "-o", path(name)},
                                     more));
      EXPECT_EQ(outcome.status, 0) << outcome.messages;
      return render::read_png(path(name)).bytes;
    };
    save_robot(robot, make_voxel_robot(VoxelGrid(2, 2, 2, 3)));
    LiveScene scene(test::on_cpu(environment == "land" ? Environment(Land{}) : Environment(Ocean{})));
    ViewSettings view = scene.view();
    view.layout = Layout::grid;
    scene.set_view(view);
    test::open_and_wait(scene, {robot});
    ASSERT_EQ(scene.robots().entries().size(), 1u);
    const auto as_window = [&](const std::string& name, bool hero, float aperture) {
      const auto picture = scene.exports().video({.output = path(name),
                                                  .size = {160, 90},
                                                  .still = 0.2,
                                                  .hero = hero,
                                                  .aperture = aperture,
                                                  .quality = render::Quality::low});
      const VideoStatus status = over(*picture);
      EXPECT_EQ(status.state, VideoStatus::State::done) << status.error;
      EXPECT_EQ(status.frames, 1);
      return render::read_png(path(name)).bytes;
    };
    const std::string start = environment + "-";
    EXPECT_EQ(as_window(start + "a.png", true, 0), as_command(start + "b.png", {"--style", "hero"}));
    if (environment == "land") continue;  // a hero's lens has been compared
    const auto through_lens = as_window(start + "c.png", false, 0.1f);
    EXPECT_EQ(through_lens, as_command(start + "d.png", {"--aperture", "0.1"}));
    EXPECT_NE(through_lens, as_window(start + "e.png", false, 0));
  }
}

TEST_F(LiveVideo, CanceledGroupVideoLeavesNoFileAndEmptyOneReportsWhy) {
  LiveScene scene(test::on_cpu());
  EXPECT_EQ(over(*scene.exports().video({.output = path("none.mp4")})).state, VideoStatus::State::failed);
  test::make_robots(scene, 1);
  const auto video = scene.exports().video(
      {.output = path("long.mp4"), .size = {160, 90}, .seconds = 1000, .quality = render::Quality::low});
  video->cancel();
  video->wait();
  EXPECT_EQ(video->status().state, VideoStatus::State::canceled);
  EXPECT_TRUE(listing().empty());
}

}  // namespace
}  // namespace mercury
