// SPDX-License-Identifier: Apache-2.0
#include "app/live/session_settings.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>
#include <exception>
#include <system_error>

#include "app/live/command_text.h"
#include "app/live/robot_saving.h"
#include "app/options/config_file.h"
#include "app/options/generator_options.h"
#include "app/options/option_values.h"
#include "app/options/view_options.h"

namespace mercury {
namespace {

namespace fs = std::filesystem;

// Reads the file with the parser of the command line, so that both accept the same options.
class SettingsParser {
 public:
  SettingsParser() {
    const Command scene = program_.root().add_command("scene", "");
    view_.add_to(scene);
    generators_.add_to(scene);
    add_text(scene, "--kind", generation_.kind, "", "KIND");
    add_number(scene, "--count", generation_.count, "", "N");
    add_number(scene, "--seed", generation_.seed, "", "N");
    scene.add_flag("--pause-on-explosion", pause_, "");
    add_text(scene, "--folder", folder_, "", "PATH");
  }

  SessionSettings read(const fs::path& path) {
    const ConfigFile file(path.string(), program_.root(), *program_.root().find_command("scene"), {});
    std::vector<std::string> arguments{"scene"};
    arguments.insert(arguments.end(), file.arguments().begin(), file.arguments().end());
    program_.parse(arguments);
    SessionSettings settings{.view = view_.settings(Layout::cells), .pause_on_explosion = pause_, .folder = folder_};
    generation_.count = std::clamp<std::size_t>(generation_.count, 1, 100'000);
    generation_.values = generators_.values();
    generator_named(generation_.kind);
    for (const Generator& generator : generators()) generator.validate(generation_.values);
    settings.generation = generation_;
    return settings;
  }

 private:
  CommandTree program_{"mercury"};
  ViewOptions view_;
  GeneratorOptions generators_;
  RandomRobots generation_;
  std::string folder_;
  bool pause_ = false;
};

}  // namespace

fs::path session_settings_path() {
  if (const char* folder = std::getenv("XDG_CONFIG_HOME"); folder && *folder == '/')
    return fs::path(folder) / "mercury/scene.toml";
  if (const char* home = std::getenv("HOME"); home && *home) return fs::path(home) / ".config/mercury/scene.toml";
  return {};
}

SessionSettings load_session_settings(const fs::path& path, Messages& messages) {
  std::error_code error;
  SessionSettings usual;
  set_layout(usual.view, Layout::cells);
  if (path.empty() || !fs::exists(path, error)) return usual;
  try {
    return SettingsParser().read(path);
  } catch (const std::exception& problem) {
    const fs::path aside = unused_name(path.string() + ".broken");
    fs::rename(path, aside, error);
    messages.add(Severity::warning, fmt::format("the settings have an error and were renamed to {}: {}",
                                                error ? path.string() : aside.string(), problem.what()));
    return usual;
  }
}

void save_session_settings(const fs::path& path, const SessionSettings& settings, Messages& messages) {
  if (path.empty()) return;
  OptionValues options = options_of(settings.view);
  const RandomRobots& generation = settings.generation;
  for (const Generator& generator : generators()) {
    const OptionValues more = options_of(generator, generation.values);
    options.insert(options.end(), more.begin(), more.end());
  }
  options.emplace_back("--kind", generation.kind);
  options.emplace_back("--count", fmt::to_string(generation.count));
  options.emplace_back("--seed", fmt::to_string(generation.seed));
  if (settings.pause_on_explosion) options.emplace_back("--pause-on-explosion", "");
  if (!settings.folder.empty()) options.emplace_back("--folder", settings.folder);
  const SaveResult result =
      save_files({{path, toml_of(options, "Settings of mercury view, written when its window closes.")}}, true);
  if (!result.ok()) messages.add(Severity::warning, "settings: " + result.message);
}

}  // namespace mercury
