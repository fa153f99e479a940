// SPDX-License-Identifier: Apache-2.0
// What the user does with mouse and keyboard, in order, and how much of it one frame of the window takes.
#pragma once

#include <cstdint>
#include <deque>
#include <vector>

namespace mercury::window {

struct InputEvent {
  enum class Kind { move, enter, focus, button, scroll, key, character } kind = Kind::move;
  double x = 0, y = 0;                     // of move and scroll
  bool on = false;                         // entered, got the focus
  int code = 0;                            // GLFW's of the button or key; of a character: in Unicode
  int scancode = 0, action = 0, mods = 0;  // as GLFW gives them
  char32_t name = 0;                       // of a key: the character on it; 0 = none
  bool types = false;                      // of a key: a character follows
};

// A slow frame loses nothing: what is pressed is seen where and in the order in which it was pressed. A frame takes the
// way of the pointer, and then either one press or release of a button, or turns of the wheel, or what is typed; a key
// that types nothing ends it, as it may open what the next ones are meant for.
class InputQueue {
 public:
  void push(const InputEvent& event);
  std::vector<InputEvent> take();
  // More waits than one frame takes.
  bool behind() const { return !waiting_.empty(); }
  // Presses of buttons and keys, and notches of the wheel, taken so far.
  std::uint64_t taken() const { return taken_; }

 private:
  std::deque<InputEvent> waiting_;
  std::uint64_t taken_ = 0;
};

}  // namespace mercury::window
