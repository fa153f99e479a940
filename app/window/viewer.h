// SPDX-License-Identifier: Apache-2.0
// The interactive window: opens it, runs its loop, closes it.
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
  std::vector<Robot> robots;                 // that do not come from files
  bool welcome = false;                      // they are the samples: the camera shows one of them, then all
  std::vector<std::filesystem::path> files;  // read once the window is open
  std::vector<RandomRobots> generations;     // made once the window is open
  HeldParts held;                            // by hand
  std::filesystem::path run;                 // of an evolution, opened with the window; empty = none
  Configuration configuration;
  TrialStart start;  // where robots begin
  ViewSettings view;
  render::Quality quality = render::Quality::automatic;
  WindowSize size{0, 0};           // 0 = as last time
  std::filesystem::path report;    // where to write the event log (toolkit/event_log.h); empty = nowhere
  bool playing = true;             // start playing
  double speed = 1;                // simulated seconds per second; infinity = as fast as possible
  bool interop = true;             // positions stay on the GPU that simulates and draws
  bool paced = true;               // draw as often as the display shows frames; otherwise as often as possible
  bool remember = true;            // load the saved settings, and save them at the end
  std::vector<std::string> notes;  // messages to show first
};

// Returns the exit status when the window is closed. Throws NoDisplay if no window can be opened.
int run_viewer(ViewerOptions options);

}  // namespace mercury::window
