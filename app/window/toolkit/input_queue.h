// SPDX-License-Identifier: Apache-2.0
// Mouse and keyboard input, in order, shared out among frames.
//
// A frame may be slow (software rendering, many robots), and the user clicks and types meanwhile. A click must act on
// what the user saw at that place at that time, so one frame must not swallow several clicks. Each frame takes pointer
// moves and then one of:
//   1. one press or release of a mouse button: the next one may mean a dialog that this one opens;
//   2. turns of the wheel: the pointer must not move on before they act;
//   3. typed characters, up to the first key that types nothing (Enter, Esc, Ctrl S), for the reason of 1.
//
//   queue:  move press | release | move wheel wheel | 'a' 'b' Enter | move ...
//   frame:       1     |    2    |        3         |       4       |   5
#pragma once

#include <cstdint>
#include <deque>
#include <vector>

namespace mercury::window {

struct InputEvent {
  enum class Kind { move, enter, focus, button, scroll, key, character } kind = Kind::move;
  double x = 0, y = 0;                     // move: position; scroll: offset
  bool on = false;                         // enter, focus: true = gained
  int code = 0;                            // button, key: GLFW's number; character: Unicode
  int scancode = 0, action = 0, mods = 0;  // as GLFW passes them
  char32_t name = 0;                       // key: the character printed on it; 0 = none
  bool types = false;                      // key: a character event follows
};

class InputQueue {
 public:
  void push(const InputEvent& event);
  // The events of one frame.
  std::vector<InputEvent> take();
  // True if events are left for the next frame.
  bool has_backlog() const { return !waiting_.empty(); }
  // How many presses of buttons and keys, and notches of the wheel, frames have taken so far.
  std::uint64_t taken() const { return taken_; }

 private:
  std::deque<InputEvent> waiting_;
  std::uint64_t taken_ = 0;
};

}  // namespace mercury::window
