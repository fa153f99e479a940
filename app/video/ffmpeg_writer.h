// SPDX-License-Identifier: Apache-2.0
// Video files, encoded by the ffmpeg program as a child process.
#pragma once

#include <optional>

#include "app/base/child_process.h"
#include "app/base/interrupt.h"
#include "app/video/frame_writer.h"

namespace mercury {

// H.264 .mp4 (yuv420p, BT.709, index before the data), VP9 .webm, or .gif with a palette of its own. Writes to a
// temporary name beside the target; finish() renames it.
class FfmpegWriter final : public FrameWriter {
 public:
  FfmpegWriter(const std::string& output, VideoKind kind, const VideoSettings& settings);
  void write(const render::Image& frame) override;
  void finish() override;
  void abandon() override;
  std::string description() const override;

 private:
  [[noreturn]] void fail(int status);

  std::string output_;
  VideoKind kind_;
  std::string program_;
  UnfinishedFile file_;
  UnsavedResults frames_;
  std::optional<ChildProcess> encoder_;
};

// The arguments, without the program, that encode raw frames from standard input into `file`.
std::vector<std::string> ffmpeg_arguments(VideoKind kind, const VideoSettings& settings, const std::string& file);

// The line of an encoder's messages that says why it failed, shortened; empty if there is none.
std::string failure_line(const std::string& messages);

}  // namespace mercury
