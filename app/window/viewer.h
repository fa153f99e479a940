// SPDX-License-Identifier: Apache-2.0
// The interactive window, from its opening to its end.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "app/live/scene_document.h"
#include "app/scene/view_settings.h"
#include "app/window/toolkit/window.h"
#include "mercury/configuration.h"
#include "mercury/robot.h"
#include "render/renderer.h"

namespace mercury::window {

struct ViewerOptions {
  std::vector<Robot> robots;                 // that come from no file
  std::vector<std::filesystem::path> files;  // read when the window is open
  std::vector<RandomRobots> generations;       // made when the window is open
  Configuration configuration;
  ViewSettings view;
  render::Quality quality = render::Quality::automatic;
  WindowSize size{0, 0};           // 0 = of the last time
  std::filesystem::path report;    // where to tell what happens (log.h); empty = nowhere
  bool playing = true;             // from the start
  bool remember = true;            // settings of earlier windows are used, and kept for later ones
  std::vector<std::string> notes;  // shown at the start
};

// Returns the exit status when the window is closed. Throws NoDisplay.
int run_viewer(ViewerOptions options);

}  // namespace mercury::window
