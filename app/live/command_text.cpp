// SPDX-License-Identifier: Apache-2.0
#include "app/live/command_text.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <map>
#include <numbers>
#include <type_traits>

#include "app/base/file_name.h"
#include "app/options/generator_options.h"
#include "app/options/option_values.h"
#include "app/scene/view_words.h"
#include "mercury/names.h"

namespace mercury {
namespace {

// Appends an option unless it has its default.
class Options {
 public:
  template <class Value>
  void number(const std::string& name, Value value, Value defaults) {
    if (value != defaults) values_.emplace_back(name, fmt::format("{}", value));
  }
  void vector(const std::string& name, Vec3 value, Vec3 defaults) {
    if (value != defaults) values_.emplace_back(name, fmt::format("{},{},{}", value.x, value.y, value.z));
  }
  void text(const std::string& name, const std::string& value, std::string_view defaults) {
    if (value != defaults) values_.emplace_back(name, value);
  }
  void flag(const std::string& name, bool given) {
    if (given) values_.emplace_back(name, "");
  }
  OptionValues take() { return std::move(values_); }

 private:
  OptionValues values_;
};

template <class Parameter, class Value>
void add_parameter(Options& options, const Parameter& parameter, const Value& value, const Value& defaults) {
  if constexpr (std::is_same_v<Value, bool>)
    options.flag(switch_of(parameter.name, defaults), value != defaults);
  else if constexpr (std::is_same_v<Value, Vec3>)
    options.vector(option_of(parameter.name), value, defaults);
  else
    options.number(option_of(parameter.name), value, defaults);
}

template <class Struct>
void add_parameters(Options& options, const Struct& values) {
  for_each_parameter(values, [&](const auto& parameter, const auto& value) {
    add_parameter(options, parameter, value, parameter.default_value());
  });
}
void add_parameters(Options& options, const Environment& environment) {
  const Environment usual = environment_named(name_of(environment));
  for_each_parameter_pair(environment, usual, [&](const auto& parameter, const auto& part, const auto& usual_part) {
    add_parameter(options, parameter, part.*parameter.member, usual_part.*parameter.member);
  });
}

std::string cut_text(const render::Cut& cut) {
  const std::string axis = fmt::format("{}{}", cut.below ? "-" : "", "xyz"[cut.axis]);
  // In meters from the middle, as old files have it, or as a share.
  if (cut.shift != 0) return fmt::format("{}:{}", axis, cut.shift);
  return fmt::format("{}:{}%", axis, cut.percent);
}

// The parser turns these degrees into the same radians again.
float degrees(float radians) { return radians * 180 / std::numbers::pi_v<float>; }

std::string camera_text(const CameraPlan& camera) {
  std::string text(name_of(camera.mode));
  if (camera.mode == CameraMode::follow && !camera.robot.empty()) text.append(":").append(camera.robot);
  return text;
}

void append(std::string& line, const OptionValues& options) {
  for (const auto& [name, value] : options) {
    line.append(" ").append(name);
    // With '=', so that a value that begins with a dash is not read as an option.
    if (!value.empty()) line.append("=").append(shell_quoted(value));
  }
}

// Consecutive random robots, written as `--random KIND:COUNT:SEED:FIRST`.
struct Run {
  std::shared_ptr<const RandomRobots> generation;
  std::uint64_t first, count;
};

std::vector<Run> runs_of(const SceneDocument& document) {
  std::vector<Run> runs;
  for (const DocumentRobot& robot : document.robots) {
    const auto& [file, generation, index] = robot.source;
    if (!file.empty() || !generation) continue;
    if (!runs.empty() && runs.back().generation == generation && runs.back().first + runs.back().count == index)
      ++runs.back().count;
    else
      runs.push_back({generation, index, 1});
  }
  return runs;
}

}  // namespace

std::string toml_value(const std::string& text) {
  const bool digits = text.find_first_not_of("0123456789") == std::string::npos;
  const bool decimal = text.find_first_not_of("0123456789.-") == std::string::npos && text.find('.') > 0 &&
                       text.find('.') + 1 < text.size() && std::count(text.begin(), text.end(), '.') == 1 &&
                       text.find_last_of('-') == (text.starts_with('-') ? 0 : std::string::npos);
  if (!text.empty() && ((digits && (text == "0" || text.front() != '0') && text.size() < 19) || decimal)) return text;
  return toml_text(text);
}

OptionValues options_of(const Configuration& configuration) {
  Options options;
  const Configuration defaults;
  options.text("--device", name_of(configuration.device), "auto");
  add_parameters(options, configuration.device);
  // Always given: without it the robots' own environment would apply.
  options.text("--environment", std::string(name_of(configuration.environment)), "");
  options.text("--solver", std::string(name_of(configuration.solver)), name_of(defaults.solver));
  add_parameters(options, configuration);
  add_parameters(options, configuration.environment);
  return options.take();
}

OptionValues options_of(const EvolutionSettings& settings) {
  Options options;
  options.text("--algorithm", settings.algorithm.name, "");
  for (const std::string& objective : settings.objectives) options.text("--objective", objective, "");
  add_parameters(options, settings.algorithm);
  add_parameters(options, settings);
  constexpr TrialSettings usual = search_trials();
  for_each_parameter(settings.trials, [&](const auto& parameter, const auto& value) {
    add_parameter(options, parameter, value, usual.*parameter.member);
  });
  OptionValues values = options.take();
  std::ranges::move(options_of(settings.configuration), std::back_inserter(values));
  return values;
}

OptionValues options_of(const TrialStart& start) {
  if (!start.is_elsewhere()) return {};
  Options options;
  constexpr TrialSettings usual = one_trial();
  for_each_parameter(start.trials, [&](const auto& parameter, const auto& value) {
    if (is_of_start(parameter.name)) add_parameter(options, parameter, value, usual.*parameter.member);
  });
  options.number("--seed", start.seed, TrialStart{}.seed);
  return options.take();
}

OptionValues options_of(const ViewSettings& settings, std::optional<Layout> usual) {
  Options options;
  const ViewSettings defaults;
  const bool race = settings.layout == Layout::race;
  options.text("--color", std::string(settings.color->key), std::string(material_color().key));
  if (settings.scale) options.text("--scale", fmt::format("{},{}", settings.scale->first, settings.scale->second), "");
  if (settings.colormap) options.text("--colormap", std::string(render::name_of(*settings.colormap)), "");
  options.flag("--log-scale", settings.log_scale);
  Shown shown;
  shown.legend = settings.color->has_values();
  shown.labels = race;
  shown.path = settings.layout != Layout::grid;
  options.text("--show", shown_text(settings.shown), shown_text(shown));
  options.number("--arrow-length", settings.shown.arrows.length, 1.0f);
  options.number("--arrow-density", settings.shown.arrows.density, 1.0f);
  options.number("--arrow-threshold", settings.shown.arrows.threshold, 0.0f);
  options.text("--caption", settings.caption, "");
  options.text("--theme", settings.theme == render::Theme::light ? "light" : "dark", "dark");
  options.flag("--plain", settings.plain);
  options.flag("--smooth", settings.smooth);
  options.flag("--faceted", settings.faceted);
  options.flag("--no-footprints", !settings.footprints);
  if (settings.cut) options.text("--cut", cut_text(*settings.cut), "");
  options.text("--layout", std::string(name_of(settings.layout)), usual ? name_of(*usual) : "");
  if (settings.grid && !race)
    options.text("--grid", fmt::format("{}x{}", settings.grid->columns, settings.grid->rows), "");
  options.text("--camera", camera_text(settings.camera), "group");
  if (settings.camera.azimuth) options.number("--azimuth", degrees(*settings.camera.azimuth), NAN);
  if (settings.camera.elevation) options.number("--elevation", degrees(*settings.camera.elevation), NAN);
  options.number("--zoom", settings.camera.zoom, 1.0f);
  options.text("--bookmarks", bookmarks_text(settings.bookmarks), "");
  options.text("--compare", settings.compare ? settings.compare->text() : "", "");
  return options.take();
}

namespace {

// Adds the random robots and returns the options of their generators.
OptionValues append_random_robots(const SceneDocument& document, CommandText& command) {
  OptionValues options;
  std::map<std::string, OptionValues> shapes;
  for (const Run& run : runs_of(document)) {
    const RandomRobots& generation = *run.generation;
    command.text += fmt::format(" --random {}:{}:{}", generation.kind, run.count, generation.seed);
    if (run.first > 0) command.text += fmt::format(":{}", run.first);
    const OptionValues shape = options_of(generator_named(generation.kind), generation.values);
    const auto [first, is_new] = shapes.emplace(generation.kind, shape);
    if (is_new)
      options.insert(options.end(), shape.begin(), shape.end());
    else if (first->second != shape)
      command.notes.push_back(
          "random robots of one kind share the first one's options in the command; save the others");
  }
  return options;
}

// The command names files first, and leaves out robots that are in none.
void append_held(const SceneDocument& document, CommandText& command) {
  SceneDocument named = document;
  std::erase_if(named.robots, [](const auto& robot) { return robot.source.file.empty() && !robot.source.generation; });
  std::stable_partition(named.robots.begin(), named.robots.end(),
                        [](const auto& robot) { return !robot.source.file.empty(); });
  const HeldParts held = held_in(named);
  for (const AttachedMass& one : held.attached) command.text += " --attach=" + text_of(one);
  for (const HeldValue& one : held.drives) command.text += " --drive=" + shell_quoted(text_of(one));
  for (const HeldValue& one : held.neurons) command.text += " --neuron=" + shell_quoted(text_of(one));
}

}  // namespace

CommandText command_text(const SceneDocument& document, const ViewSettings& settings, const std::string& subcommand) {
  CommandText command{.text = fmt::format("mercury {}", subcommand)};
  for (const DocumentRobot& robot : document.robots) {
    const std::string& name = robot.body.name;
    if (robot.source.file.empty() && !robot.source.generation)
      command.notes.push_back(name + " is in no file; save it first");
    else if (robot.body.materials)
      command.notes.push_back(name + ": the changed materials are not in the command; save it first");
    if (robot.body.by_hand && subcommand != "view")
      command.notes.push_back(name + ": the muscles and neurons that are held by hand are not in the command");
    if (robot.source.file.empty()) continue;
    const std::string& file = robot.source.file;
    command.text.append(" ").append(shell_quoted(file.starts_with('-') ? fmt::format("./{}", file) : file));
  }
  const OptionValues options = append_random_robots(document, command);
  append(command.text, options);
  if (subcommand == "view")
    append_held(document, command);
  else if (!document.attachments.empty())
    command.notes.push_back("pins and attached springs are not in the command; only mercury view has them");
  append(command.text, options_of(document.start));
  append(command.text, options_of(document.configuration));
  append(command.text, options_of(settings, subcommand == "view" ? Layout::cells : Layout::grid));
  if (subcommand == "render") command.text += " -o scene.mp4";
  std::ranges::sort(command.notes);
  command.notes.erase(std::unique(command.notes.begin(), command.notes.end()), command.notes.end());
  return command;
}

std::string toml_of(const OptionValues& options, const std::string& comment) {
  std::string text = "# ";
  for (const char letter : comment) {
    text += letter;
    if (letter == '\n') text += "# ";
  }
  text += "\n";
  for (const auto& [name, value] : options)
    text += fmt::format("{} = {}\n", name.substr(2), value.empty() ? "true" : toml_value(value));
  return text;
}

}  // namespace mercury
