// SPDX-License-Identifier: Apache-2.0
// What a window remembers for the next one, apart from what the scene remembers.
#pragma once

#include <filesystem>
#include <string>

#include "app/window/toolkit/window.h"
#include "render/renderer.h"

namespace mercury::window {

struct Preferences {
  WindowSize size;
  float text_scale = 1;
  bool panels = true;                     // shown at all
  float left_width = 0, right_width = 0;  // of the columns of panels, in lines of text; 0 = as the window suggests
  std::string left_panel = "Robots", right_panel = "View";
  render::Quality quality = render::Quality::automatic;
  std::string folder;                    // shown by the browser last
  std::string open_folder, save_folder;  // where files were opened and saved last
  bool pause_on_explosion = false;
};

// Where settings are kept: $XDG_CONFIG_HOME/mercury or ~/.config/mercury; empty if neither is known.
std::filesystem::path settings_folder();

// From a file; what is missing or cannot be used is left as it is.
void load(Preferences& preferences, const std::filesystem::path& file);
// Does its best: a window whose settings cannot be written works all the same.
void save(const Preferences& preferences, const std::filesystem::path& file);

}  // namespace mercury::window
