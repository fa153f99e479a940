// SPDX-License-Identifier: Apache-2.0
// Writes an event per frame to the event log, for programs that watch the window (docs/window.md).
#pragma once

#include <cstdint>

#include "app/window/panels/panel.h"
#include "app/window/toolkit/window.h"
#include "app/window/viewport/viewport.h"
#include "mercury/stopwatch.h"

namespace mercury::window {

struct ShownView {
  ViewportArea area;
  render::Camera camera;
  double time;                    // simulated [s]
  std::int64_t drawn, presented;  // numbers of frames of the robots and of the window so far
};

class FrameReport {
 public:
  // Call once at the end of each frame. `dt`: time since the last frame [s].
  void write(PanelContext& context, const ShownView& shown, const FrameTimes& cost, double dt);

 private:
  void write_gl_messages(PanelContext& context);
  void write_robots(PanelContext& context);
  double seconds() const { return wall_now() - start_; }

  const double start_ = wall_now();
  std::int64_t frames_ = 0;
  std::uint64_t input_ = 0;  // as last written
  double written_at_ = -1;   // when a frame was last written [s]
  std::size_t robots_ = 0;
};

}  // namespace mercury::window
