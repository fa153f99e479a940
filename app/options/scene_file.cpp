// SPDX-License-Identifier: Apache-2.0
#include "app/options/scene_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <optional>

#include "app/options/config_file.h"
#include "app/options/option_values.h"
#include "app/options/robot_options.h"
#include "app/options/simulation_options.h"
#include "app/options/view_options.h"
#include "mercury/error.h"
#include "mercury/origin.h"
#include "mercury/robot_file.h"

namespace mercury {

// Reads the file with the parser of the command line, so that both accept the same options.
struct SceneFile::Parts {
  explicit Parts(const std::filesystem::path& file_path) : path(file_path) {
    const Command command = tree.root();
    robots.add_to(command);
    simulation.add_to(command);
    view.add_to(command);
    attachments.add_to(command);
    add_start_options(command, start);
    // Where a scene is computed, and how a list of files is read, is not part of it.
    for (const char* name : {"--device", "--threads", "--recursive", "--keep-going", "--follow"})
      command.remove_option(name);
  }

  std::filesystem::path path;
  CommandTree tree{"scene"};
  RobotOptions robots;
  SimulationOptions simulation;
  ViewOptions view;
  AttachmentOptions attachments;
  TrialSettings start = one_trial();
  std::optional<ConfigFile> file;
};

namespace {

// Calls work(). Errors that name an option get the file and its line, others the file.
template <class Work>
auto located_in(const SceneFile& scene, const Work& work) {
  const auto refuse = [&](const std::string& error) {
    const std::string text = scene.located(error);
    if (text.starts_with(scene.path().string())) throw InputError(text);
    throw InputError(scene.path().string(), text);
  };
  try {
    return work();
  } catch (const ParameterError& error) {
    refuse(option_of(error.parameter()) + ": " + error.problem());
  } catch (const InputError& error) {
    refuse(error.what());
  } catch (const ParseFailure& error) {
    refuse(error.text);
  }
  throw;  // refuse() has thrown
}

// The last value of an option on a command line; empty = none.
std::string value_in(const std::vector<std::string>& arguments, const std::string& option) {
  std::string value;
  for (std::size_t i = 0; i < arguments.size(); ++i) {
    if (arguments[i].starts_with(option + "=")) value = arguments[i].substr(option.size() + 1);
    if (arguments[i] == option && i + 1 < arguments.size()) value = arguments[i + 1];
  }
  return value;
}

}  // namespace

bool is_scene_name(const std::filesystem::path& path) {
  return extension_of(path) == ".toml" && path.filename() != "run.toml";
}

SceneFile::SceneFile(const std::filesystem::path& path) : parts_(std::make_unique<Parts>(path)) {
  Parts& parts = *parts_;
  located_in(*this, [&] {
    parts.file.emplace(path.string(), parts.tree.root(), parts.tree.root(), std::vector<std::string>{},
                       ConfigFile::Content::scene);
    parts.tree.parse(parts.file->arguments());
    (void)random();
    (void)view();
    (void)held();
    validate(parts.start);
    (void)parts.simulation.seconds();
    // Without an environment of its own, its parameters are those of the environment that its robots choose.
    if (!parts.simulation.chosen_environment().empty()) (void)parts.simulation.configuration(parts.robots.physics());
  });
}

SceneFile::~SceneFile() = default;
SceneFile::SceneFile(SceneFile&&) noexcept = default;
SceneFile& SceneFile::operator=(SceneFile&&) noexcept = default;

const std::filesystem::path& SceneFile::path() const { return parts_->path; }
const std::vector<std::string>& SceneFile::robots() const { return parts_->file->robots(); }
std::vector<RandomRobots> SceneFile::random() const { return parts_->robots.random(); }
HeldParts SceneFile::held() const { return parts_->attachments.held(); }
TrialStart SceneFile::start() const { return {parts_->start, parts_->robots.seed_or_default()}; }
ViewSettings SceneFile::view(Layout usual) const { return parts_->view.settings(usual); }

void SceneFile::give_body(Robot& robot, const std::string& file) const {
  located_in(*this, [&] { parts_->robots.give_body(robot, file); });
}

Configuration SceneFile::configuration(std::span<const Robot* const> files, std::vector<std::string>& notes) const {
  return located_in(*this, [&] {
    std::vector<std::string> environments;
    for (const Robot* robot : files) environments.push_back(environment_of(*robot));
    for (const RandomRobots& random : parts_->robots.random())
      environments.push_back(generator_named(random.kind).environment);
    return parts_->simulation.configuration(environments, notes, parts_->robots.physics_with(files));
  });
}

std::vector<std::string> SceneFile::arguments(const Command& command, const std::vector<std::string>& given) const {
  const std::optional<Option> environment = command.find_option("--environment");
  const bool elsewhere = environment && is_given(*environment, given) &&
                         value_in(given, "--environment") != parts_->simulation.chosen_environment();
  const bool follows = std::ranges::find(given, "--follow") != given.end();
  std::vector<std::string> taken;
  for (const std::string& argument : parts_->file->arguments()) {
    const std::string name = argument.substr(0, argument.find('='));
    const std::optional<Option> option = command.find_option(name);
    if (!option || is_given(*option, given) || (follows && name == "--camera")) continue;
    if (elsewhere && option->group() == "Environment") continue;
    taken.push_back(argument);
  }
  return taken;
}

std::string SceneFile::located(const std::string& error) const {
  return parts_->file ? parts_->file->located(error) : error;
}

}  // namespace mercury
