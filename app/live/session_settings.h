// SPDX-License-Identifier: Apache-2.0
// The settings that the window keeps between sessions, a TOML file.
#pragma once

#include <filesystem>
#include <string>

#include "app/live/messages.h"
#include "app/live/scene_document.h"
#include "app/scene/view_settings.h"

namespace mercury {

struct SessionSettings {
  ViewSettings view;
  RandomRobots generation;  // of the panel of random robots
  bool pause_on_explosion = false;
  std::string folder;  // opened last
};

// $XDG_CONFIG_HOME/mercury/scene.toml or ~/.config/mercury/scene.toml; empty if neither folder is known.
std::filesystem::path session_settings_path();

// Returns the defaults if the file does not exist. A file with errors is reported and renamed to scene.toml.broken.
SessionSettings load_session_settings(const std::filesystem::path& path, Messages& messages);
// Writes the file whole or not at all. Reports a failure.
void save_session_settings(const std::filesystem::path& path, const SessionSettings& settings, Messages& messages);

}  // namespace mercury
