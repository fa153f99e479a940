// SPDX-License-Identifier: Apache-2.0
// A scene as a line for the shell.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "app/live/scene_document.h"
#include "app/scene/view_settings.h"

namespace mercury {

struct CommandText {
  std::string text;                // "mercury view eel.json --random voxel:12 --seed 4"
  std::vector<std::string> notes;  // what the line cannot say, as unsaved robots
};

using OptionValues = std::vector<std::pair<std::string, std::string>>;  // "--dt", "0.002"; a switch has no value

// The options that differ from the defaults.
OptionValues options_of(const Configuration& configuration);
OptionValues options_of(const ViewSettings& settings);

// `subcommand` "view" or "render"; the latter writes scene.mp4.
CommandText command_text(const SceneDocument& document, const ViewSettings& settings, const std::string& subcommand);

// A word as the shell takes it, in quotes where it needs them.
std::string shell_quoted(const std::string& word);

// Options as a file for --config.
std::string toml_of(const OptionValues& options, const std::string& comment);

}  // namespace mercury
