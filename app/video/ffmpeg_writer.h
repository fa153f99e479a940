// SPDX-License-Identifier: Apache-2.0
// Video files, encoded by the ffmpeg program as a child process.
#pragma once

#include <optional>

#include "app/base/child_process.h"
#include "app/base/interrupt.h"
#include "app/video/frame_writer.h"

namespace mercury {

// H.264 .mp4 (yuv420p, BT.709, index before the data), VP9 .webm, or .gif with a palette made for it. Written under a
// temporary name beside the target, which finish() renames.
class FfmpegWriter final : public FrameWriter {
 public:
  FfmpegWriter(const std::string& output, VideoKind kind, const VideoSettings& settings);
  void write(const render::Image& frame) override;
  void finish() override;
  std::string description() const override;

 private:
  [[noreturn]] void fail(int status);

  std::string output_;
  VideoKind kind_;
  std::string program_;
  UnfinishedFile file_;
  std::optional<ChildProcess> encoder_;
};

// The command line that encodes raw frames from standard input into `file`; its program left out.
std::vector<std::string> ffmpeg_arguments(VideoKind kind, const VideoSettings& settings, const std::string& file);

// The one line of an encoder's messages that says why it failed, shortened; empty if it said nothing.
std::string telling_line(const std::string& messages);

}  // namespace mercury
