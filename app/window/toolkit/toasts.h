// SPDX-License-Identifier: Apache-2.0
// Messages that appear over the picture and go by themselves.
#pragma once

#include <deque>
#include <string>

#include "app/window/toolkit/event_log.h"

namespace mercury::window {

enum class Tone { info, success, warning, error };

class Toasts {
 public:
  void show(Tone tone, std::string text);
  // Draws them below the upper middle of a rectangle. `dt`: since the last frame [s].
  void draw(ImVec2 low, ImVec2 high, double dt, EventLog& log);
  bool empty() const { return toasts_.empty(); }

 private:
  struct Toast {
    Tone tone;
    std::string text;
    double left;  // [s]
    int count = 1;
    bool told = false;
  };
  std::deque<Toast> toasts_;
};

}  // namespace mercury::window
