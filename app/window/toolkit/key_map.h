// SPDX-License-Identifier: Apache-2.0
// Which key gives which command: the defaults of key_bindings(), changed by a file of the user.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "app/window/toolkit/key_bindings.h"

namespace mercury::window {

// The file has one line per command that has other keys than usual, in any order (docs/window.md):
//
//   # a comment
//   mutate = Ctrl M
//   step = Right, .          several keys
//   full_screen =            no key
class KeyMap {
 public:
  KeyMap();  // the defaults

  // Reads the text of a file. A key that a line gives to one command is taken from the command that has it by default.
  // Returns what is wrong with the first line that cannot be used, "3: ...", and how many more there are; empty =
  // nothing. Lines that can be used take effect all the same.
  std::string read(std::string_view text);

  // The command that a press gives, if any.
  std::optional<Action> command_of(const KeyPress& press) const;
  // For menus and help: "Right or ."; empty = none.
  std::string keys_of(Action action) const;
  // All commands with their current keys, as read() takes them.
  std::string text() const;

 private:
  struct Keys {
    std::vector<KeyChord> chords;
    bool by_user = false;
  };
  std::string read_line(std::string_view line);

  std::vector<Keys> keys_;  // per element of key_bindings()
};

// Reads a file of at most 64 KiB. A file that does not exist changes nothing. Returns one line, with the file's name,
// if it cannot be used as a whole.
std::string load_keys(KeyMap& keys, const std::filesystem::path& file);

// Writes a file of comments that lists all commands and their keys, unless the file exists. Returns whether there is
// such a file afterward.
bool write_keys_template(const std::filesystem::path& file);

// A tooltip that names the current keys of a command: "reset to the start (key R)"; without keys, the text alone.
std::string with_keys(const KeyMap& keys, const std::string& text, Action action);

}  // namespace mercury::window
