// SPDX-License-Identifier: Apache-2.0
#include "app/commands/program.h"

#include <fmt/format.h>
#include <sys/resource.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cstdio>
#include <optional>
#include <stdexcept>
#include <system_error>
#include <thread>

#include "app/base/interrupt.h"
#include "app/base/messages.h"
#include "app/base/standard_streams.h"
#include "app/base/version.h"
#include "app/commands/command_list.h"
#include "app/commands/command_table.h"
#include "app/options/config_file.h"
#include "app/options/option_values.h"
#include "app/options/scene_file.h"
#include "evolution/distribution/ranks.h"
#include "mercury/error.h"
#include "mercury/host_memory.h"
#include "mercury/names.h"
#include "mercury/stopwatch.h"
#include "robots/file/document.h"

namespace mercury {

namespace {

// In the help. Other commands follow by their names; describe-options comes after help.
constexpr std::array<std::string_view, 14> order_of_help{"view",   "render", "run",   "evolve", "new",
                                                         "mutate", "cross",  "grow",  "export", "import",
                                                         "bench",  "verify", "check", "info"};
std::vector<NamedCommand> commands_in_order() {
  std::vector<NamedCommand> commands;
  for (const NamedCommand& command : command_table)
    if (command.add != add_describe_command) commands.push_back(command);
  std::ranges::stable_sort(commands, {}, [](const NamedCommand& command) {
    return std::ranges::find(order_of_help, command.name) - order_of_help.begin();
  });
  return commands;
}

constexpr const char* footer =
    "Options may stand before or after the name of the command, and in a file for --config.\n\n"
    "Examples:\n"
    "  mercury view                                       the sample robots in a window\n"
    "  mercury render --random voxel:12 -o group.mp4      a video of twelve random robots\n"
    "  mercury run --random voxel:64 --seconds 2          simulate and print the results\n"
    "  mercury new voxel --count 10 -o my-robots          make robot files\n"
    "  mercury run my-robots --environment land           simulate them on land\n"
    "  mercury export sample:eel -o eel.glb               a robot for other programs\n"
    "  mercury info                                       what this machine can do\n"
    "  mercury help render                                all options of a command\n\n"
    "Exit status: 0 = done; 1 = the work failed, or robots were left out; 2 = the input cannot be used;\n"
    "128 + N = stopped by signal N (130 for Ctrl-C).";

// As shells number the end of a program by a signal: 130 for Ctrl-C.
int stopped_status() { return 128 + stop_signal(); }

// Whether the launcher ends this process because another one has failed, which takes a moment, and on a busy machine
// seconds until the other has come as far.
bool launcher_ends_all() {
  for (int wait = 0; wait < 3000 && !interrupted(); ++wait) std::this_thread::sleep_for(std::chrono::milliseconds(10));
  return interrupted();
}

// One line: "mercury: eel.json: ...", or as JSON {"error": {"message": "eel.json: ...", "exit": 2}}. Among the
// processes of an MPI launcher, all come upon the same mistake of the user, and the first reports it.
void print_error(const std::string& message, int status, bool as_json) {
  const int rank = rank_by_launcher();
  if (rank > 0 && launcher_ends_all()) return;
  const std::string text = (rank > 0 ? fmt::format("rank {}: ", rank) : "") + message;
  if (as_json)
    write_to_standard_error(
        fmt::format("{{\"error\": {{\"message\": {}, \"exit\": {}}}}}\n", json_text(printable(text)), status));
  else
    warn(text);
}

// Values of text options that may be empty. For all others an empty text is a mistake: a variable that a script did not
// set.
bool may_be_empty(const Option& option) { return option.name() == "caption"; }

class Program {
 public:
  Program() {
    const Command program = tree_.root();
    program.set_footer(footer);
    const Choose choose = [this](CommandBody body) { body_ = std::move(body); };
    for (const NamedCommand& command : commands_in_order()) command.add(program, choose);
    add_help_command(program);
    add_describe_command(program, choose);
    add_general_options(program);
  }

  int run(std::vector<std::string> arguments) {
    const double start = wall_now();
    errors_as_json_ = std::ranges::find(arguments, "--json") != arguments.end();
    try {
      parse(std::move(arguments));
      if (body_) say_detail(fmt::format("{}: {}", program_version, command_->full_name()));
      int status = body_ ? body_() : status_done;
      if (status == status_failed && interrupted()) status = stopped_status();
      flush_standard_output();
      if (body_) say_costs(wall_now() - start);
      return status;
    } catch (const ParameterError& error) {
      return refuse(option_of(error.parameter()) + ": " + error.problem());
    } catch (const InputError& error) {
      return refuse(error.what());
    } catch (const Interrupted&) {
      return errors_as_json_ ? fail("stopped", stopped_status()) : (say("stopped"), stopped_status());
    } catch (const std::system_error& error) {
      // A result that was longer than the buffer fails while it is printed.
      return fail(std::ferror(stdout) ? "standard output cannot be written: " + reason_of(error.code().value())
                                      : error_text(error));
    } catch (const std::exception& error) {
      return fail(error_text(error));
    }
  }

 private:
  void add_help_command(const Command& program) {
    // command_line() puts --help after the words instead.
    program.add_command("help", "Explain a command, as in mercury help new voxel")
        .add_list("COMMAND", words_of_help_, "A command, and the kind of robots of new")
        .offering(names_of_commands(program));
  }

  // The options that every command has, and --config.
  void add_general_options(const Command& command) {
    const auto add = [](const Option& option) { option.in_group("General"); };
    add(command.help_option());
    add(command.add_version_option("-V,--version", program_version, "Print the version"));
    add(command.add_flag("-q,--quiet", quiet_, "Print only errors and warnings on standard error"));
    add(command.add_flag("-v,--verbose", verbose_, "Say in detail what is done, with times"));
    const std::vector<Command> children = command.commands();
    if (children.empty())
      add(add_text(command, "--config", config_path_,
                   "Read options from a TOML file; the command line overrides them (docs/command-line.md)",
                   "FILE.toml"));
    for (const Command& child : children) add_general_options(child);
  }

  int refuse(const std::string& message) const {
    const std::string helpful = command_ ? with_suggestion(message, *command_) : message;
    return fail(located(config_ ? config_->located(helpful) : helpful), status_bad_input);
  }

  int fail(const std::string& message) const { return fail(message, interrupted() ? stopped_status() : status_failed); }

  // Reports an error and returns the exit status.
  int fail(const std::string& message, int status) const {
    print_error(message, status, errors_as_json_);
    return status;
  }

  // With the line of the scene if the error names an option that came from there.
  std::string located(const std::string& error) const {
    const std::string name = error.substr(0, error.find(':'));
    const bool from_scene = std::ranges::any_of(
        scene_options_, [&](const std::string& option) { return option.substr(0, option.find('=')) == name; });
    return from_scene ? scene_->located(error) : error;
  }

  // Puts the robots and the options of a scene in its place among the robots of a command.
  void expand_scene(const Command& command, std::size_t words, std::vector<std::string>& arguments) {
    // `info` describes the scene itself.
    if (!command.find_option("ROBOTS") || command.name() == "info") return;
    const std::vector<std::size_t> places = scenes_in(command, words, arguments);
    if (places.empty()) return;
    if (places.size() > 1) throw InputError(arguments[places[1]], "is a second scene; give one");
    scene_.emplace(arguments[places.front()]);
    if (!scene_->random().empty() && !command.find_option("--random"))
      throw InputError(scene_->path().string(),
                       fmt::format("has random robots, which {} does not take; give robot files", command.full_name()));
    const auto leave_out = [&](const char* what, bool are_held, const char* option) {
      if (are_held && !command.find_option(option))
        warn(fmt::format("{}: {} are left out; only mercury view has them", scene_->path().string(), what));
    };
    const HeldParts held = scene_->held();
    leave_out("pins and attached springs", !held.attached.empty(), "--attach");
    leave_out("drives by hand", !held.drives.empty(), "--drive");
    leave_out("neurons that are held by hand", !held.neurons.empty(), "--neuron");
    scene_options_ = scene_->arguments(command, arguments);
    const auto place = arguments.erase(arguments.begin() + static_cast<std::ptrdiff_t>(places.front()));
    arguments.insert(place, scene_->robots().begin(), scene_->robots().end());
    arguments.insert(arguments.begin() + static_cast<std::ptrdiff_t>(words), scene_options_.begin(),
                     scene_options_.end());
  }

  // Which arguments are scenes, and no values of options.
  static std::vector<std::size_t> scenes_in(const Command& command, std::size_t words,
                                            const std::vector<std::string>& arguments) {
    std::vector<std::size_t> places;
    bool only_files = false;
    for (std::size_t i = words; i < arguments.size(); ++i) {
      const std::string& argument = arguments[i];
      if (only_files || argument.size() < 2 || !argument.starts_with("-")) {
        if (is_scene_name(argument)) places.push_back(i);
        continue;
      }
      only_files = argument == "--";
      const std::optional<Option> option = command.find_option(argument);
      if (option && option->takes_value()) ++i;
    }
    return places;
  }

  void parse(std::vector<std::string> given) {
    auto [command, words, arguments] = command_line(tree_.root(), std::move(given));
    command_ = command;
    if (const std::string path = config_path_in(arguments); !path.empty()) {
      config_.emplace(path, tree_.root(), command, arguments);
      arguments.insert(arguments.begin() + static_cast<std::ptrdiff_t>(words), config_->arguments().begin(),
                       config_->arguments().end());
      errors_as_json_ |= std::ranges::find(config_->arguments(), "--json") != config_->arguments().end();
    }
    expand_scene(command, words, arguments);
    require_values(command, arguments);
    try {
      const ParsedRequest request = tree_.parse(arguments);
      if (request != ParsedRequest::run) {
        body_ = nullptr;
        if (rank_by_launcher() == 0) answer(request, command, arguments);
      }
    } catch (const UnknownArgument& argument) {
      throw unknown_argument(argument.text, command);
    } catch (const MissingValue& missing) {
      throw InputError(missing.option, "needs a value; see " + command.full_name() + " --help");
    } catch (const ParseFailure& error) {
      throw InputError(fmt::format("{}; see {} --help", error.text, command.full_name()));
    }
    set_verbosity(quiet_ ? Verbosity::quiet : verbose_ ? Verbosity::verbose : Verbosity::normal);
    if (body_) require_texts(command);
    if (config_) say_detail("options from " + config_path_);
  }

  // Prints help or version.
  static void answer(ParsedRequest request, const Command& command, const std::vector<std::string>& arguments) {
    if (request == ParsedRequest::version) {
      fmt::print("{}\n", program_version);
      return;
    }
    const bool brief = std::ranges::find(arguments, "-h") != arguments.end() &&
                       std::ranges::find(arguments, "--help") == arguments.end();
    fmt::print("{}", help_page(command, brief, columns_of_standard_output()));
  }

  // CLI11 would read the next argument as the value of "--dt=", and the value of a switch in its own way.
  static void require_values(const Command& command, const std::vector<std::string>& arguments) {
    for (const std::string& argument : arguments) {
      if (argument == "--") return;
      const std::size_t equals = argument.find('=');
      if (!argument.starts_with("--") || equals == std::string::npos) continue;
      const std::string name = argument.substr(0, equals);
      const std::optional<Option> option = command.find_option(name);
      if (option && !option->takes_value()) throw InputError(name, "is a switch; give it without a value");
      if (equals == argument.size() - 1 && !(option && may_be_empty(*option))) throw empty_value(name, command);
    }
  }

  static void require_texts(const Command& command) {
    for (const Option& option : command.options()) {
      const std::vector<std::string> texts = option.values();
      if (!option.takes_value() || may_be_empty(option)) continue;
      if (std::ranges::find(texts, "") == texts.end()) continue;
      throw empty_value(option.is_positional() ? option.name() : first_name(option), command);
    }
  }

  // As add_value() names it in messages: "-o" of "-o,--output".
  static std::string first_name(const Option& option) {
    const std::vector<std::string> names = option.short_names();
    return names.empty() ? "--" + option.name() : names.front();
  }

  static InputError empty_value(const std::string& name, const Command& command) {
    const std::optional<Option> option = command.find_option(name);
    const std::string form = option ? option->form() : "";
    return InputError(name, fmt::format("an empty value is not accepted; give {}, or leave {} out",
                                        form.empty() ? "a value" : form, name.starts_with("-") ? "the option" : "it"));
  }

  static InputError unknown_argument(const std::string& argument, const Command& command) {
    const std::string word = argument.substr(0, argument.find('='));
    if (!word.starts_with("-"))
      return InputError(printable(word, 200), fmt::format("one argument too many; see {} --help", command.full_name()));
    return InputError(printable(word, 200),
                      fmt::format("not an option of {}{}; see {} --help", command.full_name(),
                                  suggestion(word, names_of_options(command)), command.full_name()));
  }

  static void say_costs(double seconds) {
    rusage usage{};
    getrusage(RUSAGE_SELF, &usage);
    say_detail(fmt::format("took {:.2f} s, at most {} of memory", seconds,
                           byte_text(static_cast<std::size_t>(usage.ru_maxrss) * 1024)));
  }

  CommandTree tree_{"mercury", "Mercury simulates soft robots, shows them in a window and makes videos of them."};
  CommandBody body_;
  std::optional<Command> command_;  // that the command line names
  std::optional<ConfigFile> config_;
  std::optional<SceneFile> scene_;
  std::vector<std::string> scene_options_;  // "--dt=0.002": those that the command took from the scene
  bool quiet_ = false, verbose_ = false;
  bool errors_as_json_ = false;  // --json was given
  std::string config_path_;      // config_path_in() reads it earlier
  std::vector<std::string> words_of_help_;
};

// `ulimit -s` is the size of each thread's stack, too. An overflow ends the program before it can say why.
void require_stack() {
  constexpr rlim_t needed = rlim_t{256} << 10;  // 72 KiB were enough to simulate, 80 to draw without a GPU
  rlimit limit{};
  if (getrlimit(RLIMIT_STACK, &limit) == 0 && limit.rlim_cur < needed)
    throw std::runtime_error(fmt::format("the program needs {} KiB of stack, the limit is {} KiB (ulimit -s)",
                                         needed >> 10, limit.rlim_cur >> 10));
}

}  // namespace

int run_program(const std::vector<std::string>& arguments) {
  replace_closed_streams();
  catch_interrupts(launched_by_mpi());  // the launcher ends those that do not stop
  try {
    require_stack();
    return Program().run(arguments);
  } catch (const std::exception& error) {
    print_error(error_text(error), status_failed, false);
    return status_failed;
  }
}

}  // namespace mercury
