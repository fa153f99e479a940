// SPDX-License-Identifier: Apache-2.0
// The commands of the window and the keys that give them. One table serves key presses, menus, the help, the command
// palette and the file that remaps keys (key_map.h).
#pragma once

#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "app/window/toolkit/window.h"

namespace mercury::window {

enum class Action {
  play_pause,
  step,
  step_back,
  first_moment,
  present,
  loop,
  bookmark,
  next_bookmark,
  previous_bookmark,
  go_on,
  fork,
  faster,
  slower,
  real_time,
  fastest,
  reset,
  frame,
  follow,
  turntable,
  top_view,
  look_along_x,
  look_along_y,
  bookmark_1,
  bookmark_2,
  bookmark_3,
  bookmark_4,
  set_bookmark_1,
  set_bookmark_2,
  set_bookmark_3,
  set_bookmark_4,
  new_random,
  duplicate,
  remove,
  mutate,
  breed,
  evolve,
  edit_body,
  rename,
  keep_selected,
  keep_best,
  detach,  // pins and attached springs
  select_all,
  invert_selection,
  deselect,
  undo,
  redo,
  open,
  save_scene,
  save,  // robots
  drag_arrows,
  contact_arrows,
  force_arrows,
  color_material,  // the quantities of color_quantities(), in their order
  color_activation,
  color_strain,
  color_force,
  color_speed,
  color_pressure,
  color_energy,
  color_stiffness,
  color_power,
  cells,
  springs,
  labels,
  legend,
  theme,
  compare,  // two views
  ghosts,
  left_panels,
  right_panels,
  hide_panels,
  larger_text,
  smaller_text,
  full_screen,
  screenshot,
  record,
  messages,
  palette,
  help,
  quit,
};

// One command.
struct KeyBinding {
  Action action;
  const char* name;     // in the file of keys: "play_pause"
  const char* keys;     // by default, alternatives with " or " between them: "Right or ."; empty = none
  const char* meaning;  // "play or pause"
  const char* group;
  bool repeats = false;    // again while the key is held down
  const char* words = "";  // other words that find it in the command palette
};

// All commands; those of a group stand together.
std::span<const KeyBinding> key_bindings();

// A key with its modifiers. Keys that type a character are identified by it, others by GLFW's number.
struct KeyChord {
  char32_t character = 0;  // in lower case; 0 = the key types no character
  int key = 0;             // GLFW_KEY_*; 0 for a character
  bool control = false;
  bool shift = false;  // only with Ctrl, or if there is no character: a typed character already contains Shift
  friend bool operator==(const KeyChord&, const KeyChord&) = default;

  // Whether this press gives the chord. Without Ctrl, a chord without Shift is given with Shift as well.
  bool matches(const KeyPress& press) const;
};

// "Ctrl Shift S", "Right", "?", "Comma" as a chord; none if it is no key that a command can have.
std::optional<KeyChord> key_chord(std::string_view text);
// As key_chord() reads it.
std::string text_of(const KeyChord& chord);

// True for both Enter keys.
bool is_enter(const KeyPress& press);

// For the help: {"Left drag", "turn the camera"}.
struct MouseGesture {
  const char* gesture;
  const char* meaning;
};
std::span<const MouseGesture> mouse_gestures();

}  // namespace mercury::window
