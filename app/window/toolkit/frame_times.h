// SPDX-License-Identifier: Apache-2.0
// When the window draws: how long it waits between two frames, which frames it leaves out, and how long the last
// frames took.
#pragma once

#include <chrono>
#include <deque>

namespace mercury::window {

class Pacing {
 public:
  // `paced`: at most as often as displays show frames, and half as often if the processor draws, whose cores the steps
  // need, too; otherwise as often as possible.
  Pacing(bool paced, bool software) : paced_(paced), software_(software) {}

  // How long the next frame may wait for events [s]. `spent`: since the last one began [s]. `gpu_for_steps`: the user
  // only watches robots that step as fast as a GPU can, and what drawing takes of its time is missing there.
  double wait(double spent, bool gpu_for_steps) const;
  // If drawing is slow, input queues up. Handling it comes first; a frame now and then shows the progress.
  bool leaves_out_frame(bool backlog) const;
  // Whether the robots of the last frame stay: then frames get a small share of the GPU's time.
  bool keeps_robots(bool gpu_for_steps) const;

  // `seconds`: that drawing and showing it took; `robots`: it drew them.
  void showed_frame(double seconds, bool robots);

 private:
  using Clock = std::chrono::steady_clock;
  double rest() const;  // from now on, so that frames have their share of the GPU's time [s]
  static double since(Clock::time_point begin) { return std::chrono::duration<double>(Clock::now() - begin).count(); }

  bool paced_, software_;
  Clock::time_point shown_at_, drawn_at_;
  double frame_seconds_ = 0, robots_seconds_ = 0;  // of the last frame that was shown, and with robots
};

// The parts of one frame [s].
struct FrameTimes {
  double whole = 0;      // from one frame to the next
  double scene = 0;      // taking over the newest state from the physics
  double positions = 0;  // part of the view: bringing positions to the renderer
  double drawn = 0;      // drawing the robots
  double mouse = 0;      // following it, and finding what it points at
  double panels = 0;     // drawing the panels
  double thumbnails = 0;
  double waiting = 0;  // for the GPU to finish the frame; measured only for a report, else part of the next
  double present = 0;  // bringing the frame to the display
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
