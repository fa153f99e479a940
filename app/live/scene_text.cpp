// SPDX-License-Identifier: Apache-2.0
#include "app/live/scene_text.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <map>

#include "app/options/generator_options.h"
#include "mercury/robot_file.h"
#include "robots/file/document.h"

namespace mercury {
namespace {

namespace fs = std::filesystem;

// Whether a seed makes the robot as it is.
bool is_random(const DocumentRobot& robot) {
  return robot.source.generation && robot.source.file.empty() && !robot.body.materials &&
         robot.body.name == robot.body.robot->name;
}

// What each robot of the scene becomes.
enum class Form { file, random, beside };

// Files come first in a scene, then random robots. So a random robot stays one if no other follows it.
std::vector<Form> forms_of(const std::vector<SceneRobot>& robots) {
  std::vector<Form> forms(robots.size(), Form::beside);
  bool only_random = true;
  for (std::size_t i = robots.size(); i-- > 0;) {
    const bool random = robots[i].file.empty() && is_random(*robots[i].robot);
    only_random = only_random && random;
    if (!robots[i].file.empty())
      forms[i] = Form::file;
    else if (only_random)
      forms[i] = Form::random;
  }
  return forms;
}

// The options of a kind's generator are written once.
void keep_one_shape_per_kind(const std::vector<SceneRobot>& robots, std::vector<Form>& forms) {
  std::map<std::string, OptionValues> shapes;
  std::size_t last_other = 0;  // one past the last random robot that needs a file
  for (std::size_t i = 0; i < robots.size(); ++i) {
    if (forms[i] != Form::random) continue;
    const RandomRobots& generation = *robots[i].robot->source.generation;
    const OptionValues shape = options_of(generator_named(generation.kind), generation.values);
    if (shapes.emplace(generation.kind, shape).first->second != shape) last_other = i + 1;
  }
  for (std::size_t i = 0; i < last_other; ++i)
    if (forms[i] == Form::random) forms[i] = Form::beside;
}

std::string quoted(const std::string& text) {
  json_text(text);  // throws unless it is UTF-8, as TOML is
  const std::string value = toml_value(text);
  return value.starts_with('"') ? value : fmt::format("\"{}\"", value);
}

std::string list_of(const std::vector<std::string>& texts) {
  std::string list = "[";
  for (const std::string& text : texts) list += (list.size() > 1 ? ",\n  " : "\n  ") + quoted(text);
  return list + (texts.empty() ? "]" : "\n]");
}

// Consecutive random robots of one request: KIND:COUNT:SEED:FIRST.
void add_random(const DocumentRobot& robot, std::vector<std::string>& random, OptionValues& options) {
  const RandomRobots& generation = *robot.source.generation;
  const OptionValues shape = options_of(generator_named(generation.kind), generation.values);
  for (const auto& option : shape)
    if (std::ranges::find(options, option) == options.end()) options.push_back(option);
  random.push_back(fmt::format("{}:1:{}:{}", generation.kind, generation.seed, robot.source.index));
}

// Requests of which each goes on where the one before ends become one.
std::vector<std::string> joined(const std::vector<SceneRobot>& robots, const std::vector<Form>& forms,
                                OptionValues& options) {
  std::vector<std::string> random;
  const DocumentRobot* last = nullptr;
  std::uint64_t first = 0, count = 0;
  for (std::size_t i = 0; i < robots.size(); ++i) {
    if (forms[i] != Form::random) continue;
    const DocumentRobot& robot = *robots[i].robot;
    const bool goes_on = last && last->source.generation->kind == robot.source.generation->kind &&
                         last->source.generation->seed == robot.source.generation->seed &&
                         first + count == robot.source.index;
    if (goes_on) {
      random.back() =
          fmt::format("{}:{}:{}:{}", robot.source.generation->kind, ++count, robot.source.generation->seed, first);
    } else {
      add_random(robot, random, options);
      first = robot.source.index;
      count = 1;
    }
    last = &robot;
  }
  return random;
}

std::string camera_text(const CameraPlan& camera) {
  std::string text = fmt::format("\n[camera]\nmode = \"{}\"\n", name_of(camera.mode));
  // A point, so that TOML reads a real number.
  const auto number = [](float value) {
    std::string digits = fmt::format("{}", value);
    if (digits.find_first_of(".e") == std::string::npos) digits += ".0";
    return digits;
  };
  const auto add = [&](const char* key, float value) { text += fmt::format("{} = {}\n", key, number(value)); };
  if (!camera.robot.empty()) text += fmt::format("robot = {}\n", quoted(camera.robot));
  if (camera.azimuth) add("azimuth", *camera.azimuth);
  if (camera.elevation) add("elevation", *camera.elevation);
  add("zoom", camera.zoom);
  add("field_of_view", camera.field_of_view);
  add("period", static_cast<float>(camera.period));
  if (camera.target)
    text += fmt::format("target = [{}, {}, {}]\n", number(camera.target->x), number(camera.target->y),
                        number(camera.target->z));
  if (camera.distance) add("distance", *camera.distance);
  return text;
}

bool is_of_scene(const std::pair<std::string, std::string>& option) {
  constexpr const char* others[] = {"--device", "--threads", "--camera", "--azimuth", "--elevation", "--zoom"};
  return std::ranges::find(others, option.first) == std::end(others);
}

}  // namespace

SceneOutput scene_files(const fs::path& path, const std::vector<SceneRobot>& robots, const Configuration& configuration,
                        const ViewSettings& view, const HeldParts& held, const TrialStart& start) {
  std::vector<Form> forms = forms_of(robots);
  keep_one_shape_per_kind(robots, forms);
  const fs::path folder = fs::absolute(path).parent_path(), beside = path.stem().string() + "-robots";
  SceneOutput result;
  std::vector<std::string> files;
  FileNames names;
  for (std::size_t i = 0; i < robots.size(); ++i) {
    if (forms[i] == Form::random) continue;
    if (forms[i] == Form::file) {
      std::error_code error;
      const fs::path relative = fs::proximate(fs::absolute(robots[i].file), folder, error);
      files.push_back((error ? fs::absolute(robots[i].file) : relative).string());
      continue;
    }
    files.push_back((beside / (names.of(robots[i].robot->body.name) + ".json")).string());
    result.files.push_back(
        {path.parent_path() / files.back(), serialize_robot(whole_robot(*robots[i].robot), RobotFormat::json)});
    result.beside.push_back(i);
  }
  OptionValues options;
  const std::vector<std::string> random = joined(robots, forms, options);
  for (const OptionValues& more : {options_of(start), options_of(configuration), options_of(view)})
    std::ranges::copy_if(more, std::back_inserter(options), is_of_scene);
  std::string text = "# A scene of Mercury, for mercury view, render, run and info.\n";
  text += "format = \"mercury-scene\"\nversion = 1\n";
  text += fmt::format("robots = {}\n", list_of(files));
  if (!random.empty()) text += fmt::format("random = {}\n", list_of(random));
  const auto add_list = [&](const char* key, const auto& parts) {
    std::vector<std::string> texts;
    for (const auto& one : parts) texts.push_back(text_of(one));
    if (!texts.empty()) text += fmt::format("{} = {}\n", key, list_of(texts));
  };
  add_list("attach", held.attached);
  add_list("drive", held.drives);
  add_list("neuron", held.neurons);
  for (const auto& [name, value] : options) {
    json_text(value);
    text += fmt::format("{} = {}\n", name.substr(2), value.empty() ? "true" : toml_value(value));
  }
  result.files.push_back({path, text + camera_text(view.camera)});
  return result;
}

}  // namespace mercury
