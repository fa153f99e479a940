// SPDX-License-Identifier: Apache-2.0
// The command line that makes a scene again ("Copy as command").
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "app/live/scene_document.h"
#include "app/scene/view_settings.h"
#include "mercury/evolution.h"

namespace mercury {

struct CommandText {
  std::string text;                // "mercury view eel.json --random voxel:12 --seed 4"
  std::vector<std::string> notes;  // what the line cannot express, such as unsaved robots
};

using OptionValues = std::vector<std::pair<std::string, std::string>>;  // "--dt", "0.002"; a switch has no value

// The options that differ from the defaults.
OptionValues options_of(const Configuration& configuration);
// The same, but the algorithm and the objectives are always given.
OptionValues options_of(const EvolutionSettings& settings);
// Nothing for robots that begin at rest.
OptionValues options_of(const TrialStart& start);
// `usual`: the layout that is left out; absent = none.
OptionValues options_of(const ViewSettings& settings, std::optional<Layout> usual = {});

// `subcommand`: "view", or "render", which writes scene.mp4.
CommandText command_text(const SceneDocument& document, const ViewSettings& settings, const std::string& subcommand);

// A value of a TOML file: numbers as they are, all else as text in quotes.
std::string toml_value(const std::string& text);

// Options as the text of a file for --config, with a comment at its head.
std::string toml_of(const OptionValues& options, const std::string& comment);

}  // namespace mercury
