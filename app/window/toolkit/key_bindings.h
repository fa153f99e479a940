// SPDX-License-Identifier: Apache-2.0
// The commands of the window and the keys that give them. One table serves both to look up key presses and to list the
// keys in the help.
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
  fastest,
  reset,
  frame,
  follow,
  turntable,
  top_view,
  new_random,
  duplicate,
  remove,
  mutate,
  evolve,
  select_all,
  deselect,
  undo,
  redo,
  open,
  save_scene,
  save,  // robots
  drag_arrows,
  color,  // with a number: the position of the colour quantity
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

struct KeyBinding {
  Action action;
  const char* keys;  // as shown to the user: "Ctrl S"
  const char* meaning;
  const char* group;
  char32_t character;  // lower case; 0 = matched by `key` alone
  int key;             // GLFW_KEY_*; 0 = matched by `character` alone
  bool control;        // with Ctrl
  bool repeats;        // again while the key is held down
};

// All bindings; those of a group stand together.
std::span<const KeyBinding> key_bindings();

struct Command {
  Action action;
  int number = 0;  // for Action::color, from 1
};

// The command that a key press gives, if any.
std::optional<Command> command_of(const KeyPress& press);

// True for both Enter keys.
bool is_enter(const KeyPress& press);

// For the help: {"Left drag", "turn the camera"}.
struct MouseGesture {
  const char* gesture;
  const char* meaning;
};
std::span<const MouseGesture> mouse_gestures();

}  // namespace mercury::window
