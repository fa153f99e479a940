// SPDX-License-Identifier: Apache-2.0
#include "app/options/config_file.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <sstream>

#define TOML_EXCEPTIONS 1
#include <toml++/toml.h>

#include "app/scene/camera_plan.h"
#include "mercury/error.h"
#include "mercury/names.h"
#include "mercury/samples.h"

namespace mercury {
namespace {

// The options of a command and of those below it, without dashes.
void collect_keys(const Command& command, std::vector<std::string>& keys) {
  for (const Option& option : command.options())
    for (const std::string& name : option.long_names())
      if (name != "--config" && name != "--help" && name != "--version") keys.push_back(name.substr(2));
  for (const Command& child : command.commands()) collect_keys(child, keys);
}

// A scalar as written on the command line; empty for other nodes.
std::string scalar_text(const toml::node& node) {
  if (const auto text = node.value_exact<std::string>()) return *text;
  if (const auto whole = node.value_exact<std::int64_t>()) return fmt::to_string(*whole);
  if (const auto number = node.value_exact<double>()) return fmt::format("{}", *number);
  return {};
}

// The arguments of one key; empty for a flag that is false. Throws std::invalid_argument for a value that no option
// accepts.
std::vector<std::string> arguments_of(const Option& option, const std::string& name, const toml::node& value) {
  const bool is_flag = !option.takes_value();
  if (const auto flag = value.value_exact<bool>()) {
    if (!is_flag) throw std::invalid_argument("is not a switch; give a value");
    return *flag ? std::vector{name} : std::vector<std::string>{};
  }
  if (is_flag) throw std::invalid_argument("is a switch; give true or false");
  if (const toml::array* array = value.as_array()) {
    std::vector<std::string> parts;
    for (const toml::node& element : *array) {
      if (scalar_text(element).empty()) throw std::invalid_argument("has an element that is neither number nor text");
      parts.push_back(scalar_text(element));
    }
    if (!array->empty() && array->is_homogeneous<std::string>()) {
      for (std::string& part : parts) part = name + "=" + part;
      return parts;
    }
    return {fmt::format("{}={}", name, fmt::join(parts, ","))};
  }
  if (!value.is_string() && scalar_text(value).empty())
    throw std::invalid_argument("is of a kind that no option takes");
  return {name + "=" + scalar_text(value)};
}

toml::table parse(const std::string& path, ConfigFile::Content content) {
  const std::string option = content == ConfigFile::Content::scene ? "" : "--config";
  const auto refuse = [&](const std::string& what) {
    if (option.empty()) throw InputError(path, what);
    throw InputError(option, fmt::format("{} {}", path, what));
  };
  std::error_code error;
  const std::filesystem::file_status status = std::filesystem::status(path, error);
  // Opening a pipe would wait for a writer.
  if (std::filesystem::exists(status) && !std::filesystem::is_regular_file(status))
    refuse("is not a file; give a TOML file");
  std::ifstream stream(path, std::ios::binary);
  if (!stream) refuse(fmt::format("cannot be read: {}", std::strerror(errno)));
  try {
    return toml::parse(stream, path);
  } catch (const toml::parse_error& failure) {
    // "Error while parsing key-value pair: expected '=', saw 'i'"
    std::string_view problem = failure.description();
    const std::size_t colon = problem.find(": ");
    if (problem.starts_with("Error while parsing") && colon != problem.npos) problem.remove_prefix(colon + 2);
    throw InputError(fmt::format("{}:{}", path, failure.source().begin.line), fmt::format("not TOML: {}", problem));
  }
}

}  // namespace

bool is_given(const Option& option, const std::vector<std::string>& given) {
  return std::any_of(given.begin(), given.end(), [&](const std::string& argument) {
    for (const std::string& name : option.long_names())
      if (argument == name || argument.starts_with(name + "=")) return true;
    for (const std::string& name : option.short_names())
      if (argument.starts_with(name) && !argument.starts_with("--")) return true;
    return false;
  });
}

ConfigFile::ConfigFile(const std::string& path, const Command& program, const Command& command,
                       const std::vector<std::string>& given, Content content)
    : path_(path), command_(command), given_(given), content_(content) {
  toml::table table = parse(path, content);
  if (content == Content::scene) take_scene(table);
  take(table, program);
}

// Takes out what is not an option.
template <class Table>
void ConfigFile::take_scene(Table& table) {
  const toml::node* const format = table.get("format");
  if (!format || format->template value<std::string>() != "mercury-scene")
    throw InputError(path_,
                     "is not a scene: format = \"mercury-scene\" is missing; options alone are given by --config");
  const toml::node* const version = table.get("version");
  if (!version || version->template value<std::int64_t>() != 1)
    throw InputError(version ? where(*version) : path_, "is not of version 1, which this program reads");
  if (const toml::node* const robots = table.get("robots")) {
    const toml::array* const list = robots->as_array();
    if (!list) throw InputError(where(*robots), "robots must be a list of files, as in [\"eel.json\"]");
    const std::filesystem::path folder = std::filesystem::path(path_).parent_path();
    for (const toml::node& file : *list) {
      const auto name = file.value<std::string>();
      if (!name || name->empty() || name->find('\0') != std::string::npos)
        throw InputError(where(file), "robots must be a list of files, each a text that is not empty");
      const std::string relative = (folder / sample_or_path(*name)).string();
      robots_.push_back(relative.starts_with("-") ? "./" + relative : relative);
    }
  }
  if (const toml::node* const camera = table.get("camera")) {
    const auto file = camera->template value<std::string>();
    if (const toml::table* const members = camera->as_table()) take_camera(*members);
    // A camera file stands beside the scene, as robots do.
    const bool is_file = file && is_camera_file(*file);
    if (is_file) take_camera_option((std::filesystem::path(path_).parent_path() / *file).string(), *camera);
    if (camera->is_table() || is_file) table.erase("camera");
  }
  for (const char* own : {"format", "version", "robots"}) table.erase(own);
}

// As the text of a camera file, which --camera takes too.
template <class Table>
void ConfigFile::take_camera(const Table& camera) {
  const std::vector<std::string> known{"mode",          "robot",  "azimuth", "elevation", "zoom",
                                       "field_of_view", "period", "target",  "distance"};
  for (const auto& [key, value] : camera)
    if (std::ranges::find(known, key.str()) == known.end())
      throw InputError(where(value), fmt::format("\"{}\" is not a key of [camera]{}", key.str(),
                                                 suggestion(std::string(key.str()), known)));
  std::ostringstream text;
  text << toml::json_formatter{camera};
  std::string json = text.str();
  std::ranges::replace(json, '\n', ' ');
  take_camera_option(json, camera);
}

template <class Node>
void ConfigFile::take_camera_option(const std::string& value, const Node& node) {
  arguments_.push_back("--camera=" + value);
  lines_["--camera"] = static_cast<unsigned>(node.source().begin.line);
}

// Tables come after the keys above them, which they override.
template <class Table>
void ConfigFile::take(const Table& table, const Command& scope) {
  for (const auto& [key, value] : table)
    if (!value.is_table()) take_key(std::string(key.str()), value, scope);
  for (const auto& [key, value] : table) {
    if (!value.is_table()) continue;
    const std::optional<Command> child = scope.find_command(std::string(key.str()));
    if (!child) {
      std::vector<std::string> names;
      for (const Command& one : scope.commands()) names.push_back(one.name());
      if (content_ == Content::scene)
        throw InputError(where(value), fmt::format("[{}] is not a table of a scene; it has [camera]", key.str()));
      throw InputError(where(value), fmt::format("[{}] is not a command of {}{}", key.str(), scope.full_name(),
                                                 suggestion(std::string(key.str()), names)));
    }
    take(*value.as_table(), *child);
  }
}

template <class Node>
void ConfigFile::take_key(const std::string& key, const Node& value, const Command& scope) {
  std::vector<std::string> known;
  collect_keys(scope, known);
  if (content_ == Content::scene) known.insert(known.end(), {"format", "version", "robots", "camera"});
  if (std::ranges::find(known, key) == known.end() && content_ == Content::scene)
    throw InputError(where(value),
                     fmt::format("\"{}\" is not a key of a scene{}; see docs/formats.md", key, suggestion(key, known)));
  if (std::ranges::find(known, key) == known.end())
    throw InputError(where(value),
                     fmt::format("\"{}\" is not an option of {}{}; see {} --help", key, scope.full_name(),
                                 suggestion(key, known), (command_.is_within(scope) ? command_ : scope).full_name()));
  if (!command_.is_within(scope)) return;
  const std::optional<Option> option = command_.find_option("--" + key);
  if (!option || is_given(*option, given_)) return;
  const std::string name = "--" + key;
  try {
    const std::vector<std::string> taken = arguments_of(*option, name, value);
    if (content_ == Content::scene && std::ranges::find(taken, name + "=") != taken.end())
      throw std::invalid_argument("is empty; leave the key out");
    std::erase_if(arguments_, [&](const std::string& old) { return old == name || old.starts_with(name + "="); });
    arguments_.insert(arguments_.end(), taken.begin(), taken.end());
    lines_[name] = static_cast<unsigned>(value.source().begin.line);
  } catch (const std::invalid_argument& error) {
    throw InputError(where(value), fmt::format("{} {}", name, error.what()));
  }
}

template <class Node>
std::string ConfigFile::where(const Node& node) const {
  return fmt::format("{}:{}", path_, static_cast<unsigned>(node.source().begin.line));
}

std::string ConfigFile::located(const std::string& error) const {
  const auto found = lines_.find(error.substr(0, error.find(':')));
  return found == lines_.end() ? error : fmt::format("{}:{}: {}", path_, found->second, error);
}

std::string config_path_in(const std::vector<std::string>& arguments) {
  constexpr std::string_view prefix = "--config=";
  std::string path;
  for (std::size_t i = 0; i < arguments.size() && arguments[i] != "--"; ++i) {
    if (arguments[i].starts_with(prefix)) path = arguments[i].substr(prefix.size());
    if (arguments[i] == "--config" && i + 1 < arguments.size()) path = arguments[i + 1];
  }
  return path;
}

}  // namespace mercury
