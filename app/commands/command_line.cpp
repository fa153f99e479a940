// SPDX-License-Identifier: Apache-2.0
#include "app/commands/command_line.h"

#include <fmt/format.h>

#include <algorithm>

#include "app/base/messages.h"
#include "app/base/suggestion.h"
#include "mercury/error.h"

namespace mercury {
namespace {

// The subcommands, also hidden ones.
std::vector<CLI::App*> children_of(CLI::App& command) {
  return command.get_subcommands([](const CLI::App*) { return true; });
}

// An option of that name of a command or of one below it; no two of them differ in whether they take a value.
const CLI::Option* find_option(CLI::App& command, const std::string& name) {
  if (const CLI::Option* own = command.get_option_no_throw(name)) return own;
  for (CLI::App* child : children_of(command))
    if (const CLI::Option* found = find_option(*child, name)) return found;
  return nullptr;
}

// "--dt" of "--dt=0.1", "-o" of "-ofile".
std::string name_of_option(const std::string& argument) {
  return argument.starts_with("--") ? argument.substr(0, argument.find('=')) : argument.substr(0, 2);
}

// Splits a command line into the words of its command, the options before them and the arguments behind them.
class Reordering {
 public:
  Reordering(CLI::App& program, const std::vector<std::string>& given) : program_(program), given_(given) {}

  CommandLine result() {
    CLI::App* command = &program_;
    while (!children_of(*command).empty()) {
      take_options();
      if (place_ == given_.size()) break;
      CLI::App* child = child_named(*command, given_[place_]);
      if (!child) throw unknown_command(*command, given_[place_]);
      words_.push_back(given_[place_++]);
      command = child;
    }
    if (!children_of(*command).empty() && !asks_for_help()) throw no_command(*command);
    CommandLine line{.command = command, .words = words_.size(), .arguments = words_};
    line.arguments.insert(line.arguments.end(), before_.begin(), before_.end());
    line.arguments.insert(line.arguments.end(), given_.begin() + static_cast<std::ptrdiff_t>(place_), given_.end());
    return line;
  }

 private:
  void take_options() {
    while (place_ < given_.size() && given_[place_].size() > 1 && given_[place_].starts_with("-")) {
      const std::string name = name_of_option(given_[place_]);
      const CLI::Option* option = find_option(program_, name);
      if (!option)
        throw InputError(name, fmt::format("not an option{}; see mercury --help",
                                           suggestion(name, names_of_options(program_, true))));
      const bool has_value = option->get_items_expected_max() > 0 && given_[place_] == name;
      before_.push_back(given_[place_++]);
      if (has_value && place_ < given_.size()) before_.push_back(given_[place_++]);
    }
  }

  bool asks_for_help() const {
    return std::ranges::any_of(before_, [](const std::string& option) {
      return option == "-h" || option == "--help" || option == "-V" || option == "--version";
    });
  }

  static CLI::App* child_named(CLI::App& command, const std::string& word) {
    const std::vector<CLI::App*> children = children_of(command);
    const auto found = std::ranges::find(children, word, [](const CLI::App* child) { return child->get_name(); });
    return found == children.end() ? nullptr : *found;
  }

  static InputError unknown_command(const CLI::App& command, const std::string& word) {
    return InputError(fmt::format("\"{}\" is not a command{}; see {} --help", printable(word, 200),
                                  suggestion(word, names_of_commands(command)), full_name(command)));
  }

  static InputError no_command(const CLI::App& command) {
    return InputError(fmt::format("no command given; see {} --help", full_name(command)));
  }

  CLI::App& program_;
  const std::vector<std::string>& given_;
  std::size_t place_ = 0;
  std::vector<std::string> words_, before_;
};

}  // namespace

CommandLine command_line(CLI::App& program, std::vector<std::string> arguments) {
  const bool asks_to_explain =
      !arguments.empty() && arguments.front() == "help" && std::ranges::find(arguments, "--help") == arguments.end();
  if (asks_to_explain) {
    arguments.erase(arguments.begin());
    arguments.emplace_back("--help");
    // Of "help run --json", the options mean nothing.
    std::stable_partition(arguments.begin(), arguments.end(),
                          [](const std::string& word) { return !word.starts_with("-"); });
  }
  return Reordering(program, arguments).result();
}

std::string full_name(const CLI::App& command) {
  return command.get_parent() ? full_name(*command.get_parent()) + " " + command.get_name() : command.get_name();
}

std::vector<std::string> names_of_commands(const CLI::App& command) {
  std::vector<std::string> names;
  for (const CLI::App* child : command.get_subcommands([](const CLI::App* one) { return !one->get_group().empty(); }))
    names.push_back(child->get_name());
  return names;
}

std::vector<std::string> names_of_options(const CLI::App& command, bool below) {
  std::vector<std::string> names;
  for (const CLI::Option* option : command.get_options())
    for (const std::string& name : option->get_lnames()) names.push_back("--" + name);
  if (below)
    for (const CLI::App* child : command.get_subcommands([](const CLI::App*) { return true; })) {
      const std::vector<std::string> more = names_of_options(*child, true);
      names.insert(names.end(), more.begin(), more.end());
    }
  return names;
}

}  // namespace mercury
