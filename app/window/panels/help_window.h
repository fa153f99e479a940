// SPDX-License-Identifier: Apache-2.0
// Help: a window that lists all keys and mouse gestures, and the first gestures over the view.
#pragma once

#include <array>
#include <initializer_list>

#include "app/window/panels/panel.h"
#include "app/window/toolkit/event_log.h"
#include "app/window/toolkit/key_map.h"
#include "app/window/viewport/viewport.h"

namespace mercury::window {

// The user may close it, which sets `open` to false.
void draw_help(bool& open, const KeyMap& keys, EventLog& log);

// The four gestures of the mouse, shown quietly over the view until each has been used once.
class FirstSteps {
 public:
  // Draws the gestures that are new to the user at the bottom of the view, between what is `taken`, as far as there
  // is room. Never takes the mouse. `dt`: time since the last frame [s].
  void draw(PanelContext& context, const ViewportArea& area, std::initializer_list<Box> taken, double dt);
  bool fading() const { return fading_; }

 private:
  std::array<float, 4> opacity_{1, 1, 1, 1};
  bool fading_ = false;
};

}  // namespace mercury::window
