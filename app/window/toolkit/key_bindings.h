// SPDX-License-Identifier: Apache-2.0
// What keys do: the one table from which they are read and explained.
#pragma once

#include <optional>
#include <span>

#include "app/window/toolkit/window.h"

namespace mercury::window {

enum class Action {
  play_pause,
  step,
  faster,
  slower,
  real_time,
  as_fast_as_it_goes,
  reset,
  frame,
  follow,
  turntable,
  top_view,
  new_random,
  duplicate,
  remove,
  mutate,
  select_all,
  deselect,
  undo,
  redo,
  open,
  save,
  drag_arrows,
  color,  // 1 to 8
  springs,
  labels,
  legend,
  theme,
  hide_panels,
  full_screen,
  screenshot,
  record,
  help,
  quit,
};

struct Binding {
  Action action;
  const char* keys;  // for people: "Ctrl S"
  const char* meaning;
  const char* group;
  char32_t character;  // lower case; 0 = by key
  int key;             // GLFW_KEY_*
  bool control;
  bool repeats;  // while the key is held
};

// All of them, group by group.
std::span<const Binding> bindings();

struct Command {
  Action action;
  int number = 0;  // of Action::color, from 1
};

// What a press asks for, if anything.
std::optional<Command> command_of(const Press& press);

// Whether it is Enter, on whatever part of the keyboard.
bool is_enter(const Press& press);

// What the mouse does, for the help: {"Left drag", "turn the camera"}.
struct MouseUse {
  const char* gesture;
  const char* meaning;
};
std::span<const MouseUse> mouse_uses();

}  // namespace mercury::window
