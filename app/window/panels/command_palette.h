// SPDX-License-Identifier: Apache-2.0
// Ctrl K: one field that finds every command, robot and setting by some of its letters.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "app/window/panels/panel.h"

namespace mercury::window {

// Something that the palette can do.
struct PaletteEntry {
  std::string name;    // "duplicate the selected robots"
  std::string group;   // "Robots", shown at the right
  std::string detail;  // its key, or its current value; may be empty
  std::function<void()> act;
  std::string words = {};  // others that find it: "turntable spin"
};

class CommandPalette {
 public:
  // `list` makes the entries; it is called when the palette opens.
  void open(std::function<std::vector<PaletteEntry>()> list);
  void close() { open_ = false; }
  bool is_open() const { return open_; }
  // Up, Down, Page Up, Page Down and Enter; what is typed goes to the field.
  void press(const KeyPress& press);
  void draw(PanelContext& context);

 private:
  void search();
  std::optional<std::size_t> draw_entries(PanelContext& context);  // returns the one that was clicked

  bool open_ = false, just_opened_ = false, accepted_ = false;
  std::string query_;
  std::vector<PaletteEntry> entries_;
  std::vector<std::size_t> found_;  // indices of entries_, the best first
  int mark_ = 0, moved_ = 0;        // in found_; keys since the last frame
};

// What can be set by a number or a choice: parameters of solver, environment and camera, switches and lists of the
// view, colors, the robots of the scene, panels.
std::vector<PaletteEntry> settings_for_palette(PanelContext& context, const std::function<void(const char*)>& show);

}  // namespace mercury::window
