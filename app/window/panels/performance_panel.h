// SPDX-License-Identifier: Apache-2.0
// Where the time goes.
#pragma once

#include <deque>
#include <string>

#include "app/live/snapshot.h"
#include "app/window/toolkit/event_log.h"
#include "app/window/viewport/viewport.h"

namespace mercury::window {

// What the parts of one frame of the window took [s].
struct FrameTimes {
  double whole = 0;    // from frame to frame
  double scene = 0;    // following the physics
  double picture = 0;  // drawing the robots
  double panels = 0;   // this and the other panels
  double thumbnails = 0;
};

class PerformancePanel {
 public:
  void note(const FrameTimes& cost);
  void draw(const Snapshot& snapshot, const Viewport& picture, const std::string& device, const std::string& card);

 private:
  std::deque<FrameTimes> costs_;
};

}  // namespace mercury::window
