// SPDX-License-Identifier: Apache-2.0
// Commands and their options. CLI11 parses them; command.cpp is the only file that includes it, since its headers take
// longer to compile than most of ours.
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace CLI {
class App;
class Option;
}  // namespace CLI

namespace mercury {

// An option, or a word at its place ("ROBOTS"). A handle: copies name the same option, which lives as long as its
// CommandTree.
class Option {
 public:
  explicit Option(CLI::Option& option) : option_(&option) {}

  // What help says of it. Each returns the option itself.
  Option in_group(const std::string& heading) const;
  Option with_form(const std::string& form) const;  // of its value: "FILE.toml"
  Option with_help(const std::string& help) const;
  Option required() const;
  Option one_value_each() const;  // of a list: `--random A --random B` rather than `--random A B`
  // Notes for completion and for the list of options (app/commands/command_list.h): words that its value may begin with
  // beside those that its form names, or what kind of number it takes.
  Option offering(const std::vector<std::string>& values) const;
  Option as_number(bool whole) const;
  // Most users need it: -h shows it. --help shows all options.
  Option on_first_screen() const;

  bool is_positional() const;
  std::string name() const;                      // without dashes; the long one if there is one
  std::vector<std::string> short_names() const;  // "-o"
  std::vector<std::string> long_names() const;   // "--output"
  std::string help() const;
  std::string group() const;
  std::string form() const;
  bool is_required() const;
  bool takes_value() const;
  bool takes_last() const;     // if it is given several times, the last value counts
  bool takes_several() const;  // values, one after another
  std::vector<std::string> offered() const;
  std::string number_kind() const;  // "number", "whole number" or empty
  bool is_on_first_screen() const;

  // What the parsed command line gave.
  bool is_given() const;
  std::vector<std::string> values() const;

 private:
  CLI::Option* option_;
};

// A command: a program, or a word below one. A handle like Option.
class Command {
 public:
  explicit Command(CLI::App& app) : app_(&app) {}

  Command add_command(const std::string& name, const std::string& help) const;
  // A switch. `name` may list several names: "-q,--quiet".
  Option add_flag(const std::string& name, bool& value, const std::string& help) const;
  Option add_flag(const std::string& name, std::function<void()> given, const std::string& help) const;
  // One value; if it is given several times, the last one counts. `take` may throw InputError.
  Option add_option(const std::string& name, std::function<void(const std::string&)> take, const std::string& help,
                    const std::string& form) const;
  // Several values.
  Option add_list(const std::string& name, std::vector<std::string>& values, const std::string& help) const;
  Option help_option() const;  // -h,--help, which every command has
  Option add_version_option(const std::string& name, const std::string& version, const std::string& help) const;
  void remove_option(const std::string& name) const;
  void set_footer(const std::string& text) const;
  void when_chosen(std::function<void()> action) const;
  void require_command() const;  // one of those below it must be given

  std::string name() const;
  std::string full_name() const;  // "mercury new voxel"
  std::string help() const;
  std::string footer() const;  // of its own
  std::optional<Command> parent() const;
  bool is_within(const Command& other) const;  // is it, or is below it
  std::vector<Command> commands() const;
  std::optional<Command> find_command(const std::string& name) const;
  std::vector<Option> options() const;
  // By "--dt", "-o" or "ROBOTS".
  std::optional<Option> find_option(const std::string& name) const;
  bool is_given(const std::string& option) const;  // false also for an option that it lacks

 private:
  friend class CommandTree;
  CLI::App* app_;
};

// What a command line asked for.
enum class ParsedRequest { run, help, version };

// A command line that names what no command has, or that leaves out a value.
struct UnknownArgument {
  std::string text;
};
struct MissingValue {
  std::string option;
};
// Another mistake, in CLI11's words.
struct ParseFailure {
  std::string text;
};

// Owns a program's command with all below it.
class CommandTree {
 public:
  explicit CommandTree(const std::string& name = "", const std::string& help = "");
  ~CommandTree();
  CommandTree(CommandTree&&) noexcept;
  CommandTree& operator=(CommandTree&&) noexcept;

  Command root() const;
  // Calls what options and commands were given. Throws UnknownArgument, MissingValue and
  // ParseFailure, and what options throw.
  ParsedRequest parse(const std::vector<std::string>& arguments) const;

 private:
  std::unique_ptr<CLI::App> app_;
};

// What a command of the program is made of. Each has a source file of its own; program.cpp lists them.

// Runs a command after its options were parsed. Returns the exit status. Throws InputError (exit status 2) or another
// std::exception (exit status 1).
using CommandBody = std::function<int()>;

// Receives the command that the user chose.
using Choose = std::function<void(CommandBody)>;

// Adds a command to the program. Parsing the command line calls `choose`.
using AddCommand = void(const Command& program, const Choose& choose);

}  // namespace mercury
