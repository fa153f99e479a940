// SPDX-License-Identifier: Apache-2.0
// The part of the window that shows the robots.
#pragma once

#include <imgui.h>

namespace mercury::window {

// In ImGui's coordinates: pixels from the upper left corner of the window.
struct ViewportArea {
  ImVec2 low, high;
  float width() const { return high.x - low.x; }
  float height() const { return high.y - low.y; }
  float aspect() const { return width() / height(); }
};

// A part of it that something is drawn over; empty = nothing.
struct Box {
  ImVec2 low{0, 0}, high{0, 0};
  bool meets(const Box& other) const {
    return low.x < other.high.x && other.low.x < high.x && low.y < other.high.y && other.low.y < high.y;
  }
  bool holds(ImVec2 point) const { return meets({point, {point.x + 1, point.y + 1}}); }
};

}  // namespace mercury::window
