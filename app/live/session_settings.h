// SPDX-License-Identifier: Apache-2.0
// What the window remembers from one day to the next.
#pragma once

#include <filesystem>
#include <string>

#include "app/live/messages.h"
#include "app/live/scene_document.h"
#include "app/scene/view_settings.h"

namespace mercury {

struct SessionSettings {
  ViewSettings view;
  RandomRobots generation;  // of the panel that makes random robots
  bool pause_on_explosion = false;
  std::string folder;  // the last one opened
};

// $XDG_CONFIG_HOME/mercury/scene.toml, else that in ~/.config; empty where neither is known.
std::filesystem::path session_settings_path();

// The defaults where there is no such file. One that cannot be used is told of, and put aside as scene.toml.broken.
SessionSettings load_session_settings(const std::filesystem::path& path, Messages& messages);
// Written whole or not at all; told of if it cannot be.
void save_session_settings(const std::filesystem::path& path, const SessionSettings& settings, Messages& messages);

}  // namespace mercury
