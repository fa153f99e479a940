// SPDX-License-Identifier: Apache-2.0
// Films what is on the screen.
#pragma once

#include <memory>
#include <string>

#include "app/live/video_status.h"
#include "app/video/frame_writer.h"
#include "render/readback.h"

namespace mercury {

// Encodes on a thread of its own; none of its members waits, but for the destructor. The video keeps real time: a frame
// stays until the next one comes. Where the encoder cannot keep up, frames are dropped, never the window held up.
// Nothing throws; what fails is in the status. A file that exists is replaced: unused_name() (robot_saving.h) finds
// another.
class ScreenRecording {
 public:
  // `output`: .mp4, .webm, .gif, or a folder for PNG pictures. `size` of the frames; an odd last row or column is left
  // out where the encoder cannot have it.
  ScreenRecording(const std::string& output, PictureSize size, double frames_per_second = 30);
  ~ScreenRecording();  // finishes, and waits for that

  // Whether a frame at this time [s, from any origin, never going back] would be shown: reading it back is not worth
  // the while otherwise.
  bool wants(double time) const;
  // A frame in rgb, upper row first, of the size given. False if it was not taken.
  bool offer(double time, render::Image frame);
  // The last frame is in.
  void finish();
  // Leaves nothing behind.
  void cancel();
  VideoStatus status() const;
  PictureSize size() const;

 private:
  struct Parts;
  std::unique_ptr<Parts> parts_;
};

// Planes Y, U, V (BT.709, limited range) of a picture in rgb; the last row and column are left out where odd.
render::Image yuv420_of(const render::Image& rgb);

}  // namespace mercury
