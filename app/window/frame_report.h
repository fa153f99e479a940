// SPDX-License-Identifier: Apache-2.0
// What a program that watches the window is told of every frame (docs/window.md).
#pragma once

#include <chrono>

#include "app/window/panels/performance_panel.h"
#include "app/window/picture/desk.h"
#include "app/window/picture/hands.h"
#include "app/window/toolkit/window.h"

namespace mercury::window {

struct ShownPicture {
  PictureArea area;
  render::Camera camera;
  double time;  // of the robots in it [s]
};

class FrameReport {
 public:
  // `dt`: since the last frame [s].
  void tell(Desk& desk, Window& window, const ShownPicture& picture, const FrameCost& cost, double dt);

 private:
  void tell_complaints(Desk& desk, Window& window);
  void tell_robots(Desk& desk);
  double seconds() const { return std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count(); }

  const std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
  std::int64_t frames_ = 0;
  std::uint64_t input_ = 0;  // told of last
  double told_ = -1;         // when a frame was told of last [s]
  std::size_t robots_ = 0;
};

}  // namespace mercury::window
