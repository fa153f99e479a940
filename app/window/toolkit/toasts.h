// SPDX-License-Identifier: Apache-2.0
// Short messages that appear over the picture and disappear after some seconds.
#pragma once

#include <deque>
#include <string>

#include "app/window/toolkit/event_log.h"

namespace mercury::window {

enum class Tone { info, success, warning, error };

class Toasts {
 public:
  void show(Tone tone, std::string text);
  // Draws the messages at the top centre of a rectangle. `dt`: time since the last frame [s].
  void draw(ImVec2 low, ImVec2 high, double dt, EventLog& log);
  bool empty() const { return toasts_.empty(); }

 private:
  struct Toast {
    Tone tone;
    std::string text;
    double seconds_left;
    int count = 1;
    bool logged = false;
  };
  std::deque<Toast> toasts_;
};

}  // namespace mercury::window
