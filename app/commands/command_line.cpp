// SPDX-License-Identifier: Apache-2.0
#include "app/commands/program.h"

#include <fmt/format.h>

#include <algorithm>

#include "app/base/messages.h"
#include "mercury/error.h"
#include "mercury/names.h"

namespace mercury {
namespace {

// An option of that name of a command or of one below it; no two of them differ in whether they take a value.
std::optional<Option> find_option(const Command& command, const std::string& name) {
  if (const std::optional<Option> own = command.find_option(name)) return own;
  for (const Command& child : command.commands())
    if (const std::optional<Option> found = find_option(child, name)) return found;
  return std::nullopt;
}

// "--dt" of "--dt=0.1", "-o" of "-ofile".
std::string name_of_option(const std::string& argument) {
  return argument.starts_with("--") ? argument.substr(0, argument.find('=')) : argument.substr(0, 2);
}

// Splits a command line into the words of its command, the options before them and the arguments after them.
class Reordering {
 public:
  Reordering(const Command& program, const std::vector<std::string>& given) : program_(program), given_(given) {}

  CommandLine result() {
    Command command = program_;
    while (!command.commands().empty()) {
      take_options();
      if (place_ == given_.size()) break;
      const std::optional<Command> child = command.find_command(given_[place_]);
      if (!child) throw unknown_command(command, given_[place_]);
      words_.push_back(given_[place_++]);
      command = *child;
    }
    if (!command.commands().empty() && !asks_for_help()) throw no_command(command);
    CommandLine line{.command = command, .words = words_.size(), .arguments = words_};
    line.arguments.insert(line.arguments.end(), before_.begin(), before_.end());
    line.arguments.insert(line.arguments.end(), given_.begin() + static_cast<std::ptrdiff_t>(place_), given_.end());
    return line;
  }

 private:
  void take_options() {
    while (place_ < given_.size() && given_[place_].size() > 1 && given_[place_].starts_with("-")) {
      const std::string name = name_of_option(given_[place_]);
      const std::optional<Option> option = find_option(program_, name);
      if (!option)
        throw InputError(name, fmt::format("not an option{}; see mercury --help",
                                           suggestion(name, names_of_options(program_, true))));
      const bool has_value = option->takes_value() && given_[place_] == name;
      before_.push_back(given_[place_++]);
      if (has_value && place_ < given_.size()) before_.push_back(given_[place_++]);
    }
  }

  bool asks_for_help() const {
    return std::ranges::any_of(before_, [](const std::string& option) {
      return option == "-h" || option == "--help" || option == "-V" || option == "--version";
    });
  }

  static InputError unknown_command(const Command& command, const std::string& word) {
    return InputError(fmt::format("\"{}\" is not a command{}; see {} --help", printable(word, 200),
                                  suggestion(word, names_of_commands(command)), command.full_name()));
  }

  static InputError no_command(const Command& command) {
    return InputError(fmt::format("no command given; see {} --help", command.full_name()));
  }

  Command program_;
  const std::vector<std::string>& given_;
  std::size_t place_ = 0;
  std::vector<std::string> words_, before_;
};

}  // namespace

CommandLine command_line(const Command& program, std::vector<std::string> arguments) {
  // But "help -h" and "help --help" are about the word itself.
  const bool asks_to_explain = !arguments.empty() && arguments.front() == "help" &&
                               !(arguments.size() > 1 && arguments[1] == "-h") &&
                               std::ranges::find(arguments, "--help") == arguments.end();
  if (asks_to_explain) {
    arguments.erase(arguments.begin());
    arguments.emplace_back("--help");
    // Of "help run --json", the options mean nothing.
    std::stable_partition(arguments.begin(), arguments.end(),
                          [](const std::string& word) { return !word.starts_with("-"); });
  }
  return Reordering(program, arguments).result();
}

std::vector<std::string> names_of_commands(const Command& command) {
  std::vector<std::string> names;
  for (const Command& child : command.commands()) names.push_back(child.name());
  return names;
}

std::vector<std::string> names_of_options(const Command& command, bool below) {
  std::vector<std::string> names;
  for (const Option& option : command.options())
    for (const std::string& name : option.long_names()) names.push_back(name);
  if (below)
    for (const Command& child : command.commands()) {
      const std::vector<std::string> more = names_of_options(child, true);
      names.insert(names.end(), more.begin(), more.end());
    }
  return names;
}

}  // namespace mercury
