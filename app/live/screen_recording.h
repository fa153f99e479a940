// SPDX-License-Identifier: Apache-2.0
// Records the window's picture as a video.
#pragma once

#include <memory>
#include <string>

#include "app/live/video_status.h"
#include "app/video/frame_writer.h"
#include "render/readback.h"

namespace mercury {

// Encodes on its own thread. The video runs in real time: a frame stays until the next one. If the encoder is too slow,
// frames are dropped; only the destructor waits. No member throws; status() reports errors. An existing file is
// replaced; unused_name() (robot_saving.h) finds a new name.
class ScreenRecording {
 public:
  // `output`: .mp4, .webm, .gif, or a folder for PNG pictures. `size`: of the frames in pixels; where the format needs
  // even numbers, the last row or column is cut off.
  ScreenRecording(const std::string& output, PictureSize size, double frames_per_second = 30);
  ~ScreenRecording();  // finishes and waits

  // Whether the video needs a frame at this time. Ask before reading the picture back. `time` is in seconds from an
  // arbitrary origin and must not go back.
  bool wants(double time) const;
  // Adds a frame: RGB, upper row first, of the size given to the constructor. Returns false if it was dropped.
  bool offer(double time, render::Image frame);
  // No more frames follow. Does not wait.
  void finish();
  // Stops and removes the unfinished file.
  void cancel();
  VideoStatus status() const;
  PictureSize size() const;

 private:
  struct Parts;
  std::unique_ptr<Parts> parts_;
};

// Converts an RGB picture to planes Y, U, V (BT.709, limited range). Cuts off an odd last row or column.
render::Image yuv420_of(const render::Image& rgb);

}  // namespace mercury
