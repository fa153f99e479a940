// SPDX-License-Identifier: Apache-2.0
#include "app/options/config_file.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <filesystem>
#include <fstream>

#define TOML_EXCEPTIONS 1
#include <toml++/toml.h>

#include "mercury/error.h"

namespace mercury {
namespace {

CLI::Option* find_option(CLI::App& command, const std::string& key) { return command.get_option_no_throw("--" + key); }

// Whether this command or one of its subcommands has the option.
bool known_anywhere(CLI::App& command, const std::string& key) {
  if (find_option(command, key)) return true;
  const auto below = command.get_subcommands([](CLI::App*) { return true; });
  return std::any_of(below.begin(), below.end(), [&](CLI::App* child) { return known_anywhere(*child, key); });
}

bool is_given(const CLI::Option& option, const std::vector<std::string>& given) {
  return std::any_of(given.begin(), given.end(), [&](const std::string& argument) {
    for (const std::string& name : option.get_lnames())
      if (argument == "--" + name || argument.starts_with("--" + name + "=")) return true;
    for (const std::string& name : option.get_snames())
      if (argument.starts_with("-" + name) && !argument.starts_with("--")) return true;
    return false;
  });
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
std::vector<std::string> arguments_of(const CLI::Option& option, const std::string& name, const toml::node& value) {
  const bool is_flag = option.get_expected_max() == 0;
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

std::string full_name(const CLI::App& command) {
  const CLI::App* parent = command.get_parent();
  return parent && parent->get_parent() ? full_name(*parent) + "." + command.get_name() : command.get_name();
}

}  // namespace

ConfigFile::ConfigFile(const std::string& path, CLI::App& program, CLI::App& command,
                       const std::vector<std::string>& given)
    : path_(path) {
  toml::table file;
  std::ifstream stream(path, std::ios::binary);
  if (!stream || std::filesystem::is_directory(path)) throw InputError("--config", path + " cannot be read");
  try {
    file = toml::parse(stream, path);
  } catch (const toml::parse_error& error) {
    throw InputError(fmt::format("{}:{}", path, error.source().begin.line), std::string(error.description()));
  }
  const auto take = [&](const toml::table& table, CLI::App& scope) {
    for (const auto& [key, value] : table) {
      const std::string name = "--" + std::string(key.str());
      const unsigned line = static_cast<unsigned>(value.source().begin.line);
      const std::string where = fmt::format("{}:{}", path, line);
      if (value.is_table()) continue;
      if (key.str() == "config" || !known_anywhere(scope, std::string(key.str())))
        throw InputError(
            where, fmt::format("\"{}\" is not an option; mercury {} --help lists them", key.str(), command.get_name()));
      CLI::Option* option = find_option(command, std::string(key.str()));
      if (!option || is_given(*option, given)) continue;
      try {
        const std::vector<std::string> taken = arguments_of(*option, name, value);
        // A command's own table is read last and overrides the top level.
        std::erase_if(arguments_, [&](const std::string& old) { return old == name || old.starts_with(name + "="); });
        arguments_.insert(arguments_.end(), taken.begin(), taken.end());
        lines_[name] = line;
      } catch (const std::invalid_argument& error) {
        throw InputError(where, fmt::format("{} {}", name, error.what()));
      }
    }
  };
  take(file, program);
  for (const auto& [key, value] : file) {
    if (!value.is_table()) continue;
    const auto scopes = program.get_subcommands([&](const CLI::App* child) { return child->get_name() == key.str(); });
    if (scopes.empty())
      throw InputError(fmt::format("{}:{}", path, value.source().begin.line),
                       fmt::format("[{}] is not a command", key.str()));
    if (key.str() == full_name(command) || full_name(command).starts_with(std::string(key.str()) + "."))
      take(*value.as_table(), *scopes.front());
  }
}

std::string ConfigFile::located(const std::string& error) const {
  const auto found = lines_.find(error.substr(0, error.find(':')));
  return found == lines_.end() ? error : fmt::format("{}:{}: {}", path_, found->second, error);
}

std::string config_path_in(const std::vector<std::string>& arguments) {
  constexpr std::string_view prefix = "--config=";
  for (std::size_t i = 0; i < arguments.size(); ++i) {
    if (arguments[i].starts_with(prefix)) return arguments[i].substr(prefix.size());
    if (arguments[i] == "--config" && i + 1 < arguments.size()) return arguments[i + 1];
  }
  return {};
}

}  // namespace mercury
