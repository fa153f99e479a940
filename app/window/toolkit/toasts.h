// SPDX-License-Identifier: Apache-2.0
// Short messages that appear over the view and disappear after some seconds, and the history of all of them.
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
std::string clock_text(std::chrono::system_clock::time_point time);

class Toasts {
 public:
  void show(Tone tone, std::string text);
  // The height at the top of a rectangle that a message of one line takes, with space around it [pixels].
  static float line_height();
  // Draws the messages at the top center of a rectangle. `dt`: time since the last frame [s].
  void draw(ImVec2 low, ImVec2 high, double dt, EventLog& log);
  bool empty() const { return toasts_.empty(); }
  // Where the last draw() drew them: upper left and lower right corners.
  const std::vector<std::pair<ImVec2, ImVec2>>& places() const { return places_; }
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
  std::vector<std::pair<ImVec2, ImVec2>> places_;
  bool clicked_ = false;
};

}  // namespace mercury::window
