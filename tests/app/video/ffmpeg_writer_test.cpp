// SPDX-License-Identifier: Apache-2.0
// Videos and folders of pictures: the contents of the files, and failures.
#include <gmock/gmock.h>

#include <cmath>
#include <cstdlib>

#include "app/video/ffmpeg_writer.h"
#include "app/video/frame_writer.h"
#include "mercury/error.h"
#include "render/png.h"
#include "tests/app/program.h"
#include "tests/refusal.h"

namespace mercury::test {
namespace {

using render::Image;
using testing::HasSubstr;

struct Rgb {
  double r, g, b;
};

// BT.709 in limited range, from the standard's luma coefficients.
std::array<std::uint8_t, 3> yuv_of(Rgb color) {
  const double y = 0.2126 * color.r + 0.7152 * color.g + 0.0722 * color.b;
  const double u = (color.b - y) / 1.8556, v = (color.r - y) / 1.5748;
  const auto byte = [](double value) { return static_cast<std::uint8_t>(std::lround(value)); };
  return {byte(16 + 219 * y), byte(128 + 224 * u), byte(128 + 224 * v)};
}

// A frame of one color, in the format for that kind of video.
Image plain(VideoKind kind, PictureSize size, Rgb color) {
  Image image{.width = size.width, .height = size.height, .format = pixel_format_of(kind), .bytes = {}};
  image.bytes.resize(render::image_size(image.format, size.width, size.height));
  const std::size_t area = static_cast<std::size_t>(size.width) * static_cast<std::size_t>(size.height);
  if (image.format == render::PixelFormat::yuv420) {
    const auto [y, u, v] = yuv_of(color);
    std::fill_n(image.bytes.begin(), area, y);
    std::fill_n(image.bytes.begin() + static_cast<std::ptrdiff_t>(area), area / 4, u);
    std::fill_n(image.bytes.begin() + static_cast<std::ptrdiff_t>(area + area / 4), area / 4, v);
  } else {
    for (std::size_t i = 0; i < area; ++i) {
      image.bytes[3 * i] = static_cast<std::uint8_t>(std::lround(255 * color.r));
      image.bytes[3 * i + 1] = static_cast<std::uint8_t>(std::lround(255 * color.g));
      image.bytes[3 * i + 2] = static_cast<std::uint8_t>(std::lround(255 * color.b));
    }
  }
  return image;
}

// Noise, which no codec can compress.
Image noise(VideoKind kind, PictureSize size, std::uint32_t seed) {
  Image image = plain(kind, size, {});
  for (std::uint8_t& byte : image.bytes) {
    seed = seed * 1664525 + 1013904223;
    byte = static_cast<std::uint8_t>(seed >> 24);
  }
  return image;
}

class VideoTest : public FolderTest {
 protected:
  void write_video(const std::string& name, const VideoSettings& settings, int frames, Rgb color = {0.5, 0.5, 0.5}) {
    const auto writer = open_frame_writer(path(name), settings);
    for (int i = 0; i < frames; ++i) writer->write(plain(video_kind_of(path(name)), settings.size, color));
    writer->finish();
  }
};

constexpr PictureSize small{160, 90};

TEST_F(VideoTest, Mp4IsH264InYuv420) {
  write_video("a.mp4", {.size = small, .frames_per_second = 25}, 10);
  const auto stream = probe(path("a.mp4"));
  EXPECT_EQ(stream["codec_name"], "h264");
  EXPECT_EQ(stream["pix_fmt"], "yuv420p");
  EXPECT_EQ(stream["width"], 160);
  EXPECT_EQ(stream["height"], 90);
  EXPECT_EQ(stream["nb_read_frames"], "10");
  EXPECT_EQ(stream["r_frame_rate"], "25/1");
  for (const char* tag : {"color_space", "color_primaries", "color_transfer"}) EXPECT_EQ(stream[tag], "bt709") << tag;
  EXPECT_EQ(stream["color_range"], "tv");
  EXPECT_EQ(listing(), std::vector<std::string>{"a.mp4"});
}

// ISO 14496-12: a file is a sequence of boxes; each begins with its size in 4 bytes, big-endian, and its type.
TEST_F(VideoTest, Mp4HasItsIndexBeforeItsData) {
  write_video("a.mp4", {.size = small}, 5);
  const std::string file = read("a.mp4");
  std::vector<std::string> boxes;
  for (std::size_t at = 0; at + 8 <= file.size();) {
    std::size_t size = 0;
    for (std::size_t i = 0; i < 4; ++i) size = size << 8 | static_cast<std::uint8_t>(file[at + i]);
    boxes.push_back(file.substr(at + 4, 4));
    ASSERT_GE(size, 8u);
    at += size;
  }
  const auto place = [&](const char* type) { return std::find(boxes.begin(), boxes.end(), type) - boxes.begin(); };
  ASSERT_LT(place("mdat"), static_cast<std::ptrdiff_t>(boxes.size()));
  EXPECT_LT(place("moov"), place("mdat"));
}

// A player that honors the tags must show the original colors.
TEST_F(VideoTest, ColorsArePreserved) {
  const Rgb color{0.9, 0.3, 0.1};
  for (const char* name : {"a.mp4", "a.webm", "a.gif"}) {
    write_video(name, {.size = small, .frames_per_second = 25}, 3, color);
    const std::string pixels = output_of("ffmpeg", {"-v", "error", "-i", path(name), "-frames:v", "1", "-vf",
                                                    "crop=2:2:80:40", "-pix_fmt", "rgb24", "-f", "rawvideo", "-"});
    ASSERT_EQ(pixels.size(), 12u) << name;
    EXPECT_NEAR(static_cast<std::uint8_t>(pixels[0]), 255 * color.r, 4) << name;
    EXPECT_NEAR(static_cast<std::uint8_t>(pixels[1]), 255 * color.g, 4) << name;
    EXPECT_NEAR(static_cast<std::uint8_t>(pixels[2]), 255 * color.b, 4) << name;
  }
}

TEST_F(VideoTest, WebmIsVp9) {
  write_video("a.webm", {.size = small}, 6);
  const auto stream = probe(path("a.webm"));
  EXPECT_EQ(stream["codec_name"], "vp9");
  EXPECT_EQ(stream["nb_read_frames"], "6");
  EXPECT_EQ(stream["color_space"], "bt709");
}

TEST_F(VideoTest, GifKeepsItsSizeAndTime) {
  write_video("a.gif", {.size = {121, 67}, .frames_per_second = 25, .expected_frames = 10}, 10);
  const auto stream = probe(path("a.gif"));
  EXPECT_EQ(stream["codec_name"], "gif");
  EXPECT_EQ(stream["width"], 121);
  EXPECT_EQ(stream["height"], 67);
  EXPECT_NEAR(std::stod(stream["duration"].get<std::string>()), 0.4, 1e-9);
}

TEST_F(VideoTest, GifOfManyLargeFramesHasAPalettePerFrame) {
  const VideoSettings settings{.size = small, .frames_per_second = 25, .expected_frames = 1'000'000};
  write_video("a.gif", settings, 3, {1, 0, 0});
  EXPECT_EQ(probe(path("a.gif"))["nb_read_frames"], "3");
}

TEST_F(VideoTest, FolderHasAPicturePerFrame) {
  const VideoSettings settings{.size = {33, 21}};
  write_video("frames", settings, 5, {1, 0, 0.2});
  EXPECT_EQ(listing("frames"), (std::vector<std::string>{"frame-00000.png", "frame-00001.png", "frame-00002.png",
                                                         "frame-00003.png", "frame-00004.png"}));
  const Image picture = render::read_png(path("frames/frame-00004.png"));
  EXPECT_EQ(picture.width, 33);
  EXPECT_EQ(picture.height, 21);
  EXPECT_EQ(picture.bytes, plain(VideoKind::png_folder, settings.size, {1, 0, 0.2}).bytes);
}

TEST_F(VideoTest, FolderIsNewOrEmptyUnlessForced) {
  const VideoSettings settings{.size = {33, 21}};
  write_video("frames", settings, 12);
  EXPECT_THROW(open_frame_writer(path("frames"), settings), InputError);
  EXPECT_EQ(listing("frames").size(), 12u);
  write_video("frames", {.size = settings.size, .force = true}, 2);
  EXPECT_EQ(listing("frames"), (std::vector<std::string>{"frame-00000.png", "frame-00001.png"}));
}

TEST_F(VideoTest, FolderIsFilledOnce) {
  const VideoSettings settings{.size = {33, 21}, .force = true};
  {
    const auto first = open_frame_writer(path("frames"), settings);
    EXPECT_THROW(open_frame_writer(path("frames"), settings), InputError);
  }
  write_video("frames", settings, 1);
  EXPECT_EQ(listing("frames").size(), 1u);
}

// Lossless: a decoder gives the bytes that went in, even of noise.
TEST_F(VideoTest, CrfZeroKeepsEveryBit) {
  for (const char* name : {"a.mp4", "a.webm"}) {
    const VideoKind kind = video_kind_of(name);
    const VideoSettings settings{.size = small, .crf = 0};
    std::string bytes;
    {
      const auto writer = open_frame_writer(path(name), settings);
      for (std::uint32_t i = 0; i < 3; ++i) {
        const Image frame = noise(kind, small, i);
        bytes.append(frame.bytes.begin(), frame.bytes.end());
        writer->write(frame);
      }
      writer->finish();
    }
    const std::string decoded =
        output_of("ffmpeg", {"-v", "error", "-i", path(name), "-f", "rawvideo", "-pix_fmt", "yuv420p", path("raw")});
    EXPECT_EQ(probe(path(name))["pix_fmt"], "yuv420p");
    EXPECT_EQ(probe(path(name))["nb_read_frames"], "3");
    EXPECT_TRUE(read("raw") == bytes) << name;
    std::filesystem::remove(path("raw"));
  }
}

TEST_F(VideoTest, QualitiesAndRatesAreThoseOfTheFormat) {
  EXPECT_NO_THROW(require_encodable(VideoKind::mp4, 30, 51));
  EXPECT_NO_THROW(require_encodable(VideoKind::webm, 0.001, 63));
  EXPECT_NO_THROW(require_encodable(VideoKind::png_folder, 1000, std::nullopt));
  EXPECT_THROW(require_encodable(VideoKind::mp4, 30, 52), ParameterError);
  EXPECT_THROW(require_encodable(VideoKind::webm, 30, 64), ParameterError);
  EXPECT_THROW(require_encodable(VideoKind::gif, 30, 0), ParameterError);
  EXPECT_THROW(require_encodable(VideoKind::mp4, 1e-30, {}), ParameterError);
  EXPECT_THROW(require_encodable(VideoKind::gif, 0.001, {}), ParameterError);
  EXPECT_THROW(require_encodable(VideoKind::gif, 51, {}), ParameterError);
  EXPECT_THROW(require_encodable(VideoKind::mp4, std::nan(""), {}), ParameterError);
}

// The slowest and the fastest rate that are accepted give videos that play.
TEST_F(VideoTest, ExtremeRatesAreKept) {
  for (const auto& [name, rate] : {std::pair{"slow.mp4", 0.001},
                                   {"slow.webm", 0.001},
                                   {"slow.gif", 0.002},
                                   {"fast.mp4", 1000.0},
                                   {"fast.webm", 1000.0}}) {
    write_video(name, {.size = small, .frames_per_second = rate}, 3);
    EXPECT_EQ(probe(path(name))["nb_read_frames"], "3") << name;
  }
}

TEST_F(VideoTest, ParentFoldersAreMade) {
  write_video("x/y/a.mp4", {.size = small}, 2);
  write_video("x/z/", {.size = small}, 2);
  EXPECT_TRUE(std::filesystem::exists(path("x/y/a.mp4")));
  EXPECT_EQ(listing("x/z").size(), 2u);
}

TEST_F(VideoTest, UnfinishedVideosLeaveNothing) {
  for (const char* name : {"a.mp4", "frames"}) {
    const auto writer = open_frame_writer(path(name), {.size = small});
    writer->write(plain(video_kind_of(path(name)), small, {}));
  }
  EXPECT_EQ(listing(), std::vector<std::string>{});
}

TEST_F(VideoTest, ExistingFileStaysUntilTheNewOneIsComplete) {
  write("a.mp4", "the old one");
  {
    const auto writer = open_frame_writer(path("a.mp4"), {.size = small});
    writer->write(plain(VideoKind::mp4, small, {}));
    EXPECT_EQ(read("a.mp4"), "the old one");
  }
  EXPECT_EQ(read("a.mp4"), "the old one");
  write_video("a.mp4", {.size = small}, 2);
  EXPECT_EQ(probe(path("a.mp4"))["nb_read_frames"], "2");
}

TEST_F(VideoTest, NamesWithMeaningToFfmpegAreTakenLiterally) {
  write_video("-i a:b %d.mp4", {.size = small}, 2);
  EXPECT_EQ(listing(), std::vector<std::string>{"-i a:b %d.mp4"});
}

// The messages of failing videos, which leave no files behind.
class FailingVideo : public VideoTest {
 protected:
  template <class Error>
  void expect_failure(const VideoSettings& settings, const std::string& message) {
    EXPECT_THAT(refusal<Error>([&] {
                  const auto writer = open_frame_writer(path("a.mp4"), settings);
                  for (std::uint32_t i = 0; i < 60; ++i) writer->write(noise(VideoKind::mp4, settings.size, i));
                  writer->finish();
                }),
                testing::AllOf(HasSubstr(message), testing::Not(HasSubstr("\n"))));
    EXPECT_FALSE(std::filesystem::exists(path("a.mp4")));
    for (const std::string& name : listing()) EXPECT_EQ(name.find(".part"), std::string::npos) << name;
  }
};

TEST_F(FailingVideo, EncoderThatDiesIsReportedWithItsLastMessage) {
  write("dying", "#!/bin/sh\nhead -c 100000 >/dev/null\necho some warning >&2\necho 'no more ink' >&2\nexit 3\n", true);
  expect_failure<VideoError>({.size = small, .ffmpeg = path("dying")},
                             path("a.mp4") + ": the encoder " + path("dying") + " ended with status 3: no more ink");
}

TEST_F(FailingVideo, EncoderThatDiesAtTheEndIsReportedToo) {
  write("dying", "#!/bin/sh\ncat >/dev/null\nkill -9 $$\n", true);
  expect_failure<VideoError>({.size = small, .ffmpeg = path("dying")}, "was killed by signal 9 (Killed)");
}

TEST_F(FailingVideo, EncoderThatWritesNothingIsAFailure) {
  write("idle", "#!/bin/sh\ncat >/dev/null\n", true);
  expect_failure<VideoError>({.size = small, .ffmpeg = path("idle")}, "wrote nothing");
}

TEST_F(FailingVideo, FullDiskIsReported) {
  write("full",
        "#!/bin/sh\necho 'av_interleaved_write_frame(): No space left on device' >&2\necho 'Conversion failed!' "
        ">&2\nexit 1\n",
        true);
  expect_failure<VideoError>({.size = small, .ffmpeg = path("full")}, "a.mp4: the disk is full; nothing was kept");
}

TEST_F(FailingVideo, MissingEncoderNamesThePackage) {
  const char* before = std::getenv("PATH");
  const std::string saved = before ? before : "";
  setenv("PATH", folder_.c_str(), 1);
  expect_failure<VideoError>({.size = small}, "ffmpeg was not found: install the package ffmpeg (apt install ffmpeg)");
  setenv("PATH", saved.c_str(), 1);
}

TEST_F(FailingVideo, NamedEncoderMustExist) {
  expect_failure<InputError>({.size = small, .ffmpeg = path("none")},
                             "ffmpeg: " + path("none") + " cannot be started: No such file or directory");
}

TEST_F(FailingVideo, FolderThatCannotBeMadeIsBadInput) {
  write("file", "");
  EXPECT_THROW(open_frame_writer(path("file/a.mp4"), {.size = small}), InputError);
  EXPECT_THROW(open_frame_writer(path("file/"), {.size = small}), InputError);
  EXPECT_THROW(open_frame_writer(path("file"), {.size = small}), InputError);
}

TEST(FailureLine, IsTheLastLineWithAMessage) {
  EXPECT_EQ(failure_line("first\nsecond\n    Last message repeated 17 times\nConversion failed!\n"), "second");
  EXPECT_EQ(failure_line("progress 1\rprogress 2\r"), "progress 2");
  EXPECT_EQ(failure_line(""), "");
  EXPECT_EQ(failure_line("\n \n"), "");
  // The last line of ffmpeg is a guess.
  EXPECT_EQ(
      failure_line("[libx264 @ 0x5] high profile doesn't support lossless\nError initializing output stream 0:0 -- "
                   "Error while opening encoder for output stream #0:0 - maybe incorrect parameters such as "
                   "bit_rate, rate, width or height\n"),
      "[libx264 @ 0x5] high profile doesn't support lossless");
}

TEST(VideoKind, FollowsFromTheName) {
  EXPECT_EQ(video_kind_of("a.mp4"), VideoKind::mp4);
  EXPECT_EQ(video_kind_of("x.y/a.webm"), VideoKind::webm);
  EXPECT_EQ(video_kind_of("A.GIF"), VideoKind::gif);
  EXPECT_EQ(video_kind_of("frames"), VideoKind::png_folder);
  EXPECT_EQ(video_kind_of("frames.d/"), VideoKind::png_folder);
  EXPECT_THROW(video_kind_of("a.avi"), InputError);
  EXPECT_THROW(video_kind_of(""), InputError);
  EXPECT_THROW(video_kind_of("-"), InputError);
  EXPECT_THROW(video_kind_of("/dev/stdout"), InputError);
}

TEST(EncodedSize, IsEvenWhereTheCodecNeedsIt) {
  EXPECT_EQ(encoded_size(VideoKind::mp4, {641, 361}), (PictureSize{642, 362}));
  EXPECT_EQ(encoded_size(VideoKind::mp4, {640, 360}), (PictureSize{640, 360}));
  EXPECT_EQ(encoded_size(VideoKind::gif, {641, 361}), (PictureSize{641, 361}));
}

}  // namespace
}  // namespace mercury::test
