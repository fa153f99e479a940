// SPDX-License-Identifier: Apache-2.0
// Where finished frames go: a video file or a folder of pictures.
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>

#include "mercury/configuration.h"
#include "mercury/robot.h"
#include "render/readback.h"
#include "render/style.h"

namespace mercury {

struct PictureSize {
  int width = 1280, height = 720;  // [pixels]
  friend bool operator==(const PictureSize&, const PictureSize&) = default;
};

struct VideoSettings {
  PictureSize size;
  double frames_per_second = 30;
  std::int64_t expected_frames = 0;  // 0 = unknown
  std::optional<int> crf;            // constant rate factor of H.264 and VP9: lower is better; none = the usual one
  std::string comment;  // a line of metadata about what is shown; PNG pictures have it as the text "Comment"
  std::string ffmpeg;   // the encoder program; empty = MERCURY_FFMPEG, else "ffmpeg"
  std::optional<render::PixelFormat> pixels;  // of the frames, rgb or rgba; none = pixel_format_of() of the kind
  bool force = false;                         // a folder for PNG pictures may hold files, see PngFolder
};

// VideoSettings::comment of pictures that show such a robot: version, physics, environment, solver and time step.
std::string comment_of(const Robot& robot, const Configuration& configuration);

enum class VideoKind { mp4, webm, gif, apng, png_folder };

// By the name: .mp4, .webm, .gif, .apng, or a folder (no extension, a slash at the end, or an existing folder). Throws
// InputError that lists these.
VideoKind video_kind_of(const std::string& output);

// The format of the frames that FrameWriter::write takes: yuv420 if the encoder wants that, else rgb.
render::PixelFormat pixel_format_of(VideoKind kind);
// The format of the frames of a figure over a background (ViewSettings::background). Throws
// ParameterError("background",
// ...) for a transparent one that this kind of video cannot have. Opacities of a GIF are 0 or 1.
render::PixelFormat figure_pixels(VideoKind kind, render::Color background);

// Frames per second, unless the user asks for another number.
double usual_frame_rate(VideoKind kind);

// The size of the video when the user asks for `size`: H.264 and VP9 take 4:2:0 frames, whose sides are even, so odd
// sides are rounded up.
PictureSize encoded_size(VideoKind kind, PictureSize size);

// A failure that is not the user's input: the encoder is missing or died, the disk is full.
class VideoError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

// Without finish(), the destructor removes everything it wrote; an existing file of that name stays as it was.
class FrameWriter {
 public:
  virtual ~FrameWriter() = default;
  // One frame of the settings' size, in their format. Blocks while the encoder is busy.
  // Throws VideoError.
  virtual void write(const render::Image& frame) = 0;
  // Completes the video and renames it to its final name. Throws VideoError.
  virtual void finish() = 0;
  // Nothing will be kept: a write() that waits for the encoder ends soon, with VideoError. Any thread may call it.
  virtual void abandon() {}
  // For people: "H.264 by ffmpeg".
  virtual std::string description() const = 0;
};

// Throws ParameterError("size", ...) unless both sides are from 1 to 16384.
void require_drawable(PictureSize size);

// Throws ParameterError for a rate or a quality ("fps", "crf") that this kind of video does not have.
void require_encodable(VideoKind kind, double frames_per_second, std::optional<int> crf);

// Opens a writer of the kind video_kind_of(output), and makes missing parent folders. Throws InputError when the name
// or the settings cannot be used, VideoError when the encoder cannot be started.
std::unique_ptr<FrameWriter> open_frame_writer(const std::string& output, const VideoSettings& settings);

// Makes the parent folders of a file. Throws ParameterError("output", ...).
void make_parent_folder(const std::filesystem::path& output);

// The encoder program: this option, else MERCURY_FFMPEG, else "ffmpeg".
std::string encoder_program(const std::string& ffmpeg_option);

}  // namespace mercury
