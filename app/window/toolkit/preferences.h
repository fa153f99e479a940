// SPDX-License-Identifier: Apache-2.0
// The window settings that are kept for the next start. Settings of the scene are in app/live/session_settings.h.
#pragma once

#include <array>
#include <filesystem>
#include <string>

#include "app/window/toolkit/window.h"
#include "render/renderer.h"

namespace mercury::window {

struct Preferences {
  WindowSize size;
  static constexpr float least_text = 0.7f, most_text = 2.5f;
  float text_scale = 1;
  bool panels = true;                         // false = hidden
  bool left_open = true, right_open = false;  // the panel columns; false = collapsed
  float left_width = 0, right_width = 0;      // of the panel columns, in lines of text; 0 = automatic
  std::string left_panel = "Robots", right_panel = "View";
  render::Quality quality = render::Quality::automatic;
  std::string folder;                    // last shown in the browser
  std::string open_folder, save_folder;  // last used in the file dialogs
  bool pause_on_explosion = false;
  static constexpr int least_timeline = 16, most_timeline = 16384;
  std::string compared;                 // settings of the second view, as it was last
  int timeline_megabytes = 512;         // of memory for the timeline, at most
  std::array<bool, 4> gestures_used{};  // turn, move, zoom, pull; the window explains the others
};

// The folder of settings: $XDG_CONFIG_HOME/mercury or ~/.config/mercury; empty if neither variable is set.
std::filesystem::path settings_folder();

// Reads a settings file. Values that are missing or invalid leave `preferences` unchanged.
void load(Preferences& preferences, const std::filesystem::path& file);
// Writes a settings file. Failures are ignored, since the window works without it.
void save(const Preferences& preferences, const std::filesystem::path& file);

}  // namespace mercury::window
