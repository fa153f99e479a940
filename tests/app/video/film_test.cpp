// SPDX-License-Identifier: Apache-2.0
// Pictures and films that a program makes of its simulations.
#include "app/video/film.h"

#include <gmock/gmock.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <set>
#include <thread>

#include "mercury/error.h"
#include "mercury/random_voxel.h"
#include "render/png.h"
#include "tests/app/program.h"
#include "tests/refusal.h"

namespace mercury::test {
namespace {

using render::Image;
using testing::HasSubstr;

constexpr PictureSize tiny{160, 90};

class FilmTest : public FolderTest {
 protected:
  void SetUp() override {
    FolderTest::SetUp();
    try {
      render::make_context({.kind = kind})->release();
    } catch (const render::ContextError& error) {
      GTEST_SKIP() << "no OpenGL here: " << error.what();
    }
  }

  FilmOptions options(double rate = 10) const { return {.size = tiny, .frames_per_second = rate}; }

  static constexpr render::ContextKind kind = render::ContextKind::automatic;
  DrawingThread thread_{kind};
  Simulation simulation_{{.device = {.kind = DeviceKind::cpu}}, random_voxel_robots({}, 1, 2)};
};

// The mean difference of two pictures' bytes.
double difference(const Image& a, const Image& b) {
  double sum = 0;
  for (std::size_t i = 0; i < a.bytes.size(); ++i) sum += std::abs(a.bytes[i] - b.bytes[i]);
  return sum / static_cast<double>(a.bytes.size());
}

TEST_F(FilmTest, PictureHasTheRequestedSizeAndShowsTheRobots) {
  const Image picture = picture_of(thread_, simulation_, {.size = {161, 91}});
  EXPECT_EQ(picture.width, 161);
  EXPECT_EQ(picture.height, 91);
  EXPECT_EQ(picture.bytes.size(), 3u * 161 * 91);
  // Without skins, springs and masses, only the surroundings are left.
  const Image empty = picture_of(thread_, simulation_, {.size = {161, 91}, .view = {.shown = {.skin = false}}});
  EXPECT_GT(difference(picture, empty), 1);
}

TEST_F(FilmTest, SameStateGivesTheSameBytesFromAnyThread) {
  const Image first = picture_of(thread_, simulation_, {.size = tiny});
  simulation_.step(500);
  const Image moved = picture_of(thread_, simulation_, {.size = {90, 160}});
  EXPECT_NE(moved.bytes, first.bytes);
  simulation_.reset();
  std::vector<Image> again(4);
  for (Image& picture : again) std::thread([&] { picture = picture_of(thread_, simulation_, {.size = tiny}); }).join();
  for (const Image& picture : again) EXPECT_EQ(picture.bytes, first.bytes);
}

TEST_F(FilmTest, QualitiesAndQuantitiesDiffer) {
  simulation_.step(300);
  std::set<std::string> pictures;
  for (const ColorQuantity& quantity : color_quantities()) {
    const Image picture = picture_of(thread_, simulation_, {.size = tiny, .view = {.color = &quantity}});
    EXPECT_TRUE(pictures.emplace(picture.bytes.begin(), picture.bytes.end()).second) << quantity.key;
  }
  const Image low = picture_of(thread_, simulation_, {.size = tiny, .quality = render::Quality::low});
  const Image high = picture_of(thread_, simulation_, {.size = tiny, .quality = render::Quality::high});
  EXPECT_NE(low.bytes, high.bytes);
  EXPECT_LT(difference(low, high), 10);
}

TEST_F(FilmTest, FilmHasAFramePerCall) {
  {
    Film film(thread_, simulation_, path("a.mp4"), options());
    for (int frame = 0; frame < 25; ++frame, simulation_.step(10)) film.add_frame();
    EXPECT_EQ(film.frames(), 25);
    film.finish();
    EXPECT_THROW(film.add_frame(), InputError);
    EXPECT_THROW(film.finish(), InputError);
  }
  EXPECT_EQ(probe(path("a.mp4"))["nb_read_frames"], "25");
  EXPECT_EQ(probe(path("a.mp4"))["r_frame_rate"], "10/1");
  EXPECT_EQ(listing(), std::vector<std::string>{"a.mp4"});
}

// However the simulation is stepped: the frames are those of a film of the whole simulation.
TEST_F(FilmTest, FramesOfAStepWiseFilmAreThoseOfAWholeOne) {
  const auto robots = random_voxel_robots({}, 1, 2);
  const Configuration cpu{.device = {.kind = DeviceKind::cpu}};
  film_of(thread_, Simulation(cpu, robots), path("whole/"), {.size = tiny, .frames_per_second = 30}, 0.2);
  Film film(thread_, simulation_, path("stepwise/"), {.size = tiny, .frames_per_second = 30});
  film.begin_frames();
  film.observe();
  for (const std::int64_t end : {7, 33, 34, 35, 100, 101, 167}) {
    while (simulation_.steps() < end) {
      simulation_.step(std::min(film.next_step(), end) - simulation_.steps());
      film.observe();
    }
    EXPECT_EQ(film.frames(), end * 30 / 1000 + 1) << end;
  }
  film.finish();
  ASSERT_EQ(listing("whole").size(), 6u);
  for (const std::string& frame : listing("whole"))
    EXPECT_EQ(read("whole/" + frame), read("stepwise/" + frame)) << frame;
  Simulation coarse({.dt = 0.01, .device = {.kind = DeviceKind::cpu}}, robots);
  Film fast(thread_, coarse, path("fast/"), {.size = tiny, .frames_per_second = 200});
  EXPECT_THROW(fast.begin_frames(), InputError);
}

TEST_F(FilmTest, FramesArePicturesOfTheirMoment) {
  Film film(thread_, simulation_, path("frames/"), {.size = tiny});
  std::vector<Image> pictures;
  for (int frame = 0; frame < 6; ++frame, simulation_.step(200)) {
    film.add_frame();
    // Pictures and other films between frames change nothing.
    pictures.push_back(picture_of(thread_, simulation_, {.size = tiny}));
  }
  film.finish();
  const auto frames = listing("frames");
  ASSERT_EQ(frames.size(), 6u);
  for (std::size_t i = 0; i < frames.size(); ++i) {
    const Image frame = render::read_png(path("frames/" + frames[i]));
    // The camera of a film follows a little late, so later frames are only similar.
    if (i == 0)
      EXPECT_EQ(frame.bytes, pictures[0].bytes);
    else
      EXPECT_LT(difference(frame, pictures[i]), 8) << i;
  }
}

TEST_F(FilmTest, TwoFilmsAtOnceDoNotMix) {
  Simulation other({.device = {.kind = DeviceKind::cpu}}, random_voxel_robots({}, 7, 3));
  Film alone(thread_, simulation_, path("alone/"), {.size = tiny});
  for (int frame = 0; frame < 4; ++frame, simulation_.step(50)) alone.add_frame();
  alone.finish();
  simulation_.reset();
  Film one(thread_, simulation_, path("one/"), {.size = tiny});
  Film two(thread_, other, path("two/"), {.size = {90, 160}, .quality = render::Quality::medium});
  for (int frame = 0; frame < 4; ++frame, simulation_.step(50)) {
    one.add_frame();
    two.add_frame();
  }
  two.finish();
  one.finish();
  for (const std::string& frame : listing("alone")) EXPECT_EQ(read("alone/" + frame), read("one/" + frame)) << frame;
  EXPECT_EQ(listing("two").size(), 4u);
}

TEST_F(FilmTest, FilmShowsRobotsThatAreAddedAndKept) {
  Film film(thread_, simulation_, path("frames/"), {.size = tiny});
  film.add_frame();
  simulation_.add(random_voxel_robots({}, 9, 3));
  film.add_frame();
  const std::vector<std::size_t> last{4};
  simulation_.keep(last);
  film.add_frame();
  const Image one = picture_of(thread_, simulation_, {.size = tiny});
  film.finish();
  EXPECT_EQ(render::read_png(path("frames/frame-00002.png")).bytes, one.bytes);
}

TEST_F(FilmTest, DiscardedFilmLeavesTheOldFile) {
  write("a.mp4", "old");
  {
    Film film(thread_, simulation_, path("a.mp4"), options());
    for (int frame = 0; frame < 20; ++frame) film.add_frame();
  }
  Film(thread_, simulation_, path("b.mp4"), options()).discard();
  EXPECT_EQ(listing(), std::vector<std::string>{"a.mp4"});
  EXPECT_EQ(read("a.mp4"), "old");
}

TEST_F(FilmTest, FilmWithoutFramesIsAnError) {
  Film film(thread_, simulation_, path("a.mp4"), options());
  EXPECT_THROW(film.finish(), VideoError);
  EXPECT_EQ(listing(), std::vector<std::string>{});
}

TEST_F(FilmTest, DyingEncoderIsReported) {
  write("dying", "#!/bin/sh\necho 'out of ink' >&2\nexit 4\n", true);
  FilmOptions dying = options();
  dying.ffmpeg = path("dying");
  Film film(thread_, simulation_, path("a.mp4"), dying);
  try {
    for (;;) film.add_frame();
  } catch (const VideoError& error) {
    EXPECT_THAT(error.what(), HasSubstr("ended with status 4: out of ink"));
  }
  film.discard();
  EXPECT_THROW(film_of(thread_, Simulation({.device = {.kind = DeviceKind::cpu}}, random_voxel_robots({}, 1, 1)),
                       path("b.mp4"), dying, 5),
               VideoError);
  EXPECT_EQ(listing(), std::vector<std::string>{"dying"});
  EXPECT_EQ(picture_of(thread_, simulation_, {.size = tiny}).width, tiny.width) << "the thread goes on";
}

// An encoder that reads nothing and never ends: a few of these frames fill its pipe.
TEST_F(FilmTest, StuckEncoderDoesNotKeepAFilmFromEnding) {
  write("stuck", "#!/bin/sh\nexec sleep 1000\n", true);
  FilmOptions stuck = options();
  stuck.size = {640, 360};
  stuck.ffmpeg = path("stuck");
  {
    Film film(thread_, simulation_, path("a.mp4"), stuck);
    for (int frame = 0; frame < 6; ++frame) film.add_frame();
  }
  const Configuration cpu{.device = {.kind = DeviceKind::cpu}};
  int questions = 0;
  const auto go_on = [&] { return ++questions < 20; };
  EXPECT_TRUE(
      film_of(thread_, Simulation(cpu, random_voxel_robots({}, 1, 1)), path("b.mp4"), stuck, 1e4, go_on).interrupted);
  EXPECT_EQ(listing(), std::vector<std::string>{"stuck"});
}

TEST_F(FilmTest, WholeFilmsHaveTheirFramesAndCanBeStopped) {
  const auto robots = random_voxel_robots({}, 1, 2);
  const Configuration cpu{.device = {.kind = DeviceKind::cpu}};
  EXPECT_EQ(film_of(thread_, Simulation(cpu, robots), path("a.mp4"), options(), 1.2).frames, 12);
  EXPECT_EQ(probe(path("a.mp4"))["nb_read_frames"], "12");
  FilmOptions fast = options();
  fast.speed = 4;
  EXPECT_EQ(film_of(thread_, Simulation(cpu, robots), path("b.webm"), fast, 2).frames, 5);
  const VideoResult stopped =
      film_of(thread_, Simulation(cpu, robots), path("c.mp4"), options(), 1e5, [] { return false; });
  EXPECT_TRUE(stopped.interrupted);
  EXPECT_EQ(listing(), (std::vector<std::string>{"a.mp4", "b.webm"}));
}

TEST_F(FilmTest, BadOptionsAreRefusedByName) {
  for (const PictureSize size : {PictureSize{0, 90}, PictureSize{160, -1}, PictureSize{20000, 90}})
    EXPECT_EQ(refused_parameter([&] { picture_of(thread_, simulation_, {.size = size}); }), "size");
  EXPECT_EQ(refused_parameter([&] { Film(thread_, simulation_, path("a.avi"), options()); }), "output");
  EXPECT_EQ(refused_parameter([&] { Film(thread_, simulation_, path("a.gif"), options(60)); }), "fps");
  EXPECT_EQ(refused_parameter([&] { Film(thread_, simulation_, path("a.mp4"), options(-1)); }), "fps");
  ViewSettings pressure{.color = &color_quantity("pressure")};
  Simulation land({.environment = Land{}, .device = {.kind = DeviceKind::cpu}}, random_voxel_robots({}, 1, 1));
  EXPECT_EQ(refused_parameter([&] { picture_of(thread_, land, {.size = tiny, .view = pressure}); }), "color");
  EXPECT_EQ(refused_parameter([&] { film_of(thread_, std::move(land), path("a.mp4"), options(), NAN); }), "seconds");
  EXPECT_EQ(listing(), std::vector<std::string>{});
}

// In the child of a fork, drawing is an error in one line and ends nothing of the parent.
TEST_F(FilmTest, ForkedProcessGetsAnErrorAndLeavesTheFilmAlone) {
  {
    Film film(thread_, simulation_, path("a.mp4"), options());
    film.add_frame();
    const pid_t child = fork();
    if (child == 0) {
      int refusals = 0;
      try {
        picture_of(thread_, simulation_, {.size = tiny});
      } catch (const DeviceError&) {
        ++refusals;
      }
      try {
        film.add_frame();
      } catch (const DeviceError&) {
        ++refusals;
      }
      film.~Film();
      thread_.~DrawingThread();
      _exit(refusals);
    }
    int status = 0;
    ASSERT_EQ(waitpid(child, &status, 0), child);
    EXPECT_TRUE(WIFEXITED(status));
    EXPECT_EQ(WEXITSTATUS(status), 2);
    film.add_frame();
    film.finish();
  }
  EXPECT_EQ(probe(path("a.mp4"))["nb_read_frames"], "2");
}

TEST_F(FilmTest, NothingIsDrawnAfterTheEnd) {
  Film film(thread_, simulation_, path("a.mp4"), options());
  film.add_frame();
  thread_.end();
  EXPECT_THROW(picture_of(thread_, simulation_, {.size = tiny}), DeviceError);
  EXPECT_THROW(film.add_frame(), DeviceError);
  film.discard();
  EXPECT_EQ(listing(), std::vector<std::string>{});
}

TEST(DrawingThread, EndsWithoutHavingBegun) { const DrawingThread thread; }

}  // namespace
}  // namespace mercury::test
