// SPDX-License-Identifier: Apache-2.0
// Where finished frames go: a video file or a folder of pictures.
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <stdexcept>
#include <string>

#include "render/readback.h"

namespace mercury {

struct PictureSize {
  int width = 1280, height = 720;  // [pixels]
  friend bool operator==(const PictureSize&, const PictureSize&) = default;
};

struct VideoSettings {
  PictureSize size;
  double frames_per_second = 30;
  std::int64_t expected_frames = 0;  // how many will come, as far as is known; 0 = unknown
  int crf = -1;        // constant rate factor of H.264 and VP9, lower is better; -1 = the format's default
  std::string ffmpeg;  // the encoder program; empty = MERCURY_FFMPEG, else "ffmpeg"
};

enum class VideoKind { mp4, webm, gif, png_folder };

// What the name asks for: .mp4, .webm, .gif, or a folder (a name without extension, or with a slash at its end, or an
// existing folder). Throws InputError that lists these.
VideoKind video_kind_of(const std::string& output);

// How the frames of such a video are to be handed in: yuv420 where the encoder wants that, rgb elsewhere.
render::PixelFormat pixel_format_of(VideoKind kind);

// The size a video of this kind has when `size` is asked for: both codecs are fed 4:2:0
// pictures, whose sides are even, so odd ones are rounded up.
PictureSize encoded_size(VideoKind kind, PictureSize size);

// Something failed after the user's input was found good: the encoder is missing or died, the disk is full.
class VideoError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

// Without finish(), its destructor leaves nothing behind: a file of that name stays as it was.
class FrameWriter {
 public:
  virtual ~FrameWriter() = default;
  // One frame of the settings' size, in the format of pixel_format_of. Blocks while the encoder is busy.
  // Throws VideoError.
  virtual void write(const render::Image& frame) = 0;
  // Ends the video and gives it its name. Throws VideoError.
  virtual void finish() = 0;
  // For people: "H.264 by ffmpeg".
  virtual std::string description() const = 0;
};

// Opens what video_kind_of(output) says. Missing folders on the way are made. Throws InputError when the name or the
// settings cannot be used, VideoError when the encoder cannot be started.
std::unique_ptr<FrameWriter> open_frame_writer(const std::string& output, const VideoSettings& settings);

// Makes the folders on the way to a file. Throws InputError("-o: ...").
void make_parent_folder(const std::filesystem::path& output);

// The encoder program that the settings mean.
std::string encoder_program(const std::string& ffmpeg_option);

}  // namespace mercury
