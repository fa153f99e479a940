// SPDX-License-Identifier: Apache-2.0
// Short messages that disappear after some seconds, and the history of all of them.
//
// They have one line, whose room is reserved: in the menu bar, or at the top of the view while the bar is hidden. So
// they cover nothing, and the view does not move when they come and go. The line shows the newest message; its tooltip
// has all words of all current ones.
#pragma once

#include <chrono>
#include <deque>
#include <string>
#include <utility>
#include <vector>

#include "app/window/toolkit/event_log.h"

namespace mercury::window {

enum class Tone { info, success, warning, error };

// "news", "success", "warning" or "error", and the color that stands for it.
const char* name_of(Tone tone);
ImU32 color_of(Tone tone);

// A message as the history keeps it.
struct PastMessage {
  std::chrono::system_clock::time_point time;  // of the last one of `count` equal messages in a row
  Tone tone;
  std::string text;
  int count = 1;
};
// "14:03:22", in local time.
std::string time_of_day(std::chrono::system_clock::time_point time);

class Toasts {
 public:
  void show(Tone tone, std::string text);
  // The height at the top of the view that a line takes, with space around it [pixels].
  static float line_height();
  // Draws the newest message into the current ImGui window, in the middle of a line that begins at `left` and ends at
  // x = `right` [pixels of the screen]; what does not fit is left out.
  void draw(ImVec2 left, float right, EventLog& log);
  bool empty() const { return toasts_.empty(); }
  // The last 1,000 messages, the newest last.
  const std::deque<PastMessage>& history() const { return history_; }
  // Whether a message was clicked since the last call, which asks for the history. A right click only dismisses it.
  bool take_click() { return std::exchange(clicked_, false); }

 private:
  struct Toast {
    Tone tone;
    std::string text;
    double seconds_left;
    int count = 1;
    bool logged = false;
  };
  void remember(Tone tone, const std::string& text);

  std::deque<Toast> toasts_;
  std::deque<PastMessage> history_;
  bool clicked_ = false;
};

}  // namespace mercury::window
