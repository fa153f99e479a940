// SPDX-License-Identifier: Apache-2.0
// How long the last frames of the window took.
#pragma once

#include <deque>

namespace mercury::window {

// The parts of one frame [s].
struct FrameTimes {
  double whole = 0;      // from one frame to the next
  double scene = 0;      // taking over the newest state from the physics
  double positions = 0;  // part of the picture: bringing positions to the renderer
  double picture = 0;    // drawing the robots
  double panels = 0;     // drawing the panels
  double thumbnails = 0;
  double present = 0;  // bringing picture and panels to the display
};

class FrameHistory {
 public:
  // Keeps the last 240 frames.
  void add(const FrameTimes& times);
  const std::deque<FrameTimes>& frames() const { return frames_; }
  FrameTimes mean() const;

 private:
  std::deque<FrameTimes> frames_;
};

}  // namespace mercury::window
