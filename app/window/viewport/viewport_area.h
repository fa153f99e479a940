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

}  // namespace mercury::window
