// SPDX-License-Identifier: Apache-2.0
#include "app/live/session_settings.h"

#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include <algorithm>
#include <cstdlib>
#include <exception>
#include <system_error>

#include "app/live/command_text.h"
#include "app/live/robot_saving.h"
#include "app/options/config_file.h"
#include "app/options/nn_options.h"
#include "app/options/option_values.h"
#include "app/options/view_options.h"
#include "app/options/voxel_options.h"

namespace mercury {
namespace {

namespace fs = std::filesystem;

// The file's options, read as those of the command line are.
class RememberedOptions {
 public:
  RememberedOptions() {
    CLI::App& scene = *program_.add_subcommand("scene");
    view_.add_to(scene);
    voxel_.add_to(scene);
    network_.add_to(scene);
    add_choice(scene, "--kind", kind_, {"voxel", "nn"}, "");
    add_number(scene, "--count", count_, "", "N");
    add_number(scene, "--seed", seed_, "", "N");
    scene.add_flag("--pause-on-explosion", pause_);
    add_text(scene, "--folder", folder_, "", "PATH");
  }

  SessionSettings read(const fs::path& path) {
    const ConfigFile file(path.string(), program_, *program_.get_subcommand("scene"), {});
    std::vector<std::string> arguments{"scene"};
    arguments.insert(arguments.end(), file.arguments().begin(), file.arguments().end());
    program_.parse(std::vector<std::string>(arguments.rbegin(), arguments.rend()));
    SessionSettings settings{.view = view_.settings(), .pause_on_explosion = pause_, .folder = folder_};
    settings.generation.kind = kind_ == "nn" ? Generation::Kind::network : Generation::Kind::voxel;
    settings.generation.count = std::clamp<std::uint64_t>(count_, 1, 100'000);
    settings.generation.seed = seed_;
    settings.generation.voxel = voxel_.chosen();
    settings.generation.network = network_.chosen();
    return settings;
  }

 private:
  CLI::App program_{"", "mercury"};
  ViewOptions view_;
  VoxelOptions voxel_;
  NnRobotOptions network_;
  std::string kind_ = "voxel", folder_;
  std::uint64_t count_ = Generation{}.count, seed_ = Generation{}.seed;
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
  if (path.empty() || !fs::exists(path, error)) return {};
  try {
    return RememberedOptions().read(path);
  } catch (const std::exception& problem) {
    const fs::path aside = unused_name(path.string() + ".broken");
    fs::rename(path, aside, error);
    messages.add(Severity::warning, fmt::format("the settings were not understood and are put aside as {}: {}",
                                                error ? path.string() : aside.string(), problem.what()));
    return {};
  }
}

void save_session_settings(const fs::path& path, const SessionSettings& settings, Messages& messages) {
  if (path.empty()) return;
  OptionValues options = options_of(settings.view);
  for (const auto& more : {options_of(settings.generation.voxel), options_of(settings.generation.network)})
    options.insert(options.end(), more.begin(), more.end());
  const Generation& generation = settings.generation;
  options.emplace_back("--kind", generation.kind == Generation::Kind::voxel ? "voxel" : "nn");
  options.emplace_back("--count", fmt::to_string(generation.count));
  options.emplace_back("--seed", fmt::to_string(generation.seed));
  if (settings.pause_on_explosion) options.emplace_back("--pause-on-explosion", "");
  if (!settings.folder.empty()) options.emplace_back("--folder", settings.folder);
  const SaveResult result = save_files({{path, toml_of(options, "What mercury view remembers.")}}, true);
  if (!result.ok()) messages.add(Severity::warning, "settings: " + result.message);
}

}  // namespace mercury
