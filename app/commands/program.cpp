// SPDX-License-Identifier: Apache-2.0
#include "app/commands/program.h"

#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include <chrono>
#include <cstdio>
#include <exception>
#include <optional>
#include <thread>

#include "app/base/interrupt.h"
#include "app/base/messages.h"
#include "app/base/suggestion.h"
#include "app/base/version.h"
#include "app/commands/commands.h"
#include "app/options/config_file.h"
#include "app/options/option_values.h"
#include "evolution/distribution/launcher.h"
#include "mercury/error.h"

namespace mercury {
namespace {

constexpr const char* examples =
    "Examples:\n"
    "  mercury view                                              a window with the sample robots\n"
    "  mercury render --random voxel:12 --seed 1 -o group.mp4    make a video of twelve random robots\n"
    "  mercury run --random voxel:64 --seconds 2 --json          simulate and print the results\n"
    "  mercury new voxel --count 10 --seed 7 -o my-robots        make robot files\n"
    "  mercury run my-robots --environment land --csv land.csv   simulate them on land\n"
    "  mercury info                                              what this machine can do\n"
    "Help on a command: mercury render --help";

// The parser writes some messages in several lines.
std::string one_line(std::string text) {
  for (char& letter : text)
    if (letter == '\n' || letter == '\r') letter = ' ';
  return text;
}

// As shells number the end of a program by a signal: 130 for Ctrl-C.
int stopped_status() { return 128 + stop_signal(); }

// Whether the launcher ends this process because another one has failed, which takes a moment.
bool launcher_ends_all() {
  for (int wait = 0; wait < 500 && !interrupted(); ++wait) std::this_thread::sleep_for(std::chrono::milliseconds(10));
  return interrupted();
}

// Among the processes of an MPI launcher, all come upon the same mistake of the user, and the first reports it.
void print_message(const std::string& message) {
  const int rank = rank_by_launcher();
  if (rank > 0 && launcher_ends_all()) return;
  const std::string place = rank > 0 ? fmt::format("rank {}: ", rank) : "";
  warn(place + message);
}

class Program {
 public:
  Program() {
    app_.set_version_flag("--version", program_version);
    app_.footer(examples);
    app_.require_subcommand(1);
    app_.get_formatter()->column_width(34);
    const Choose choose = [this](CommandBody body) { body_ = std::move(body); };
    add_view_command(app_, choose);
    add_render_command(app_, choose);
    add_run_command(app_, choose);
    add_evolve_command(app_, choose);
    add_new_command(app_, choose);
    add_mutate_command(app_, choose);
    add_cross_command(app_, choose);
    add_grow_command(app_, choose);
    add_bench_command(app_, choose);
    add_info_command(app_, choose);
    add_describe_command(app_, choose);
  }

  int run(std::vector<std::string> arguments) {
    try {
      parse(std::move(arguments));
      if (!body_) return help_ ? status_done : status_failed;
      int status = body_();
      if (status == status_failed && interrupted()) status = stopped_status();
      if (std::fflush(stdout) != 0 || std::ferror(stdout))
        throw std::runtime_error("standard output cannot be written");
      return status;
    } catch (const ParameterError& error) {
      return refuse(option_of(error.parameter()) + ": " + error.problem());
    } catch (const InputError& error) {
      return refuse(error.what());
    } catch (const std::bad_alloc&) {
      print_message("not enough memory");
      return status_failed;
    } catch (const std::exception& error) {
      print_message(error.what());
      return interrupted() ? stopped_status() : status_failed;
    }
  }

 private:
  int refuse(const std::string& message) const {
    print_message(config_ ? config_->located(message) : message);
    return status_bad_input;
  }

  // The command that the first words name, and the number of those words.
  std::pair<CLI::App*, std::size_t> command_in(const std::vector<std::string>& arguments) {
    CLI::App* command = &app_;
    std::size_t words = 0;
    while (words < arguments.size() && !arguments[words].starts_with("-")) {
      const std::string& word = arguments[words];
      const auto found = command->get_subcommands([&](const CLI::App* child) { return child->check_name(word); });
      if (found.empty()) break;
      command = found.front();
      ++words;
    }
    return {command, words};
  }

  // Reports a missing or unknown command more clearly than the parser does.
  void require_command(CLI::App& command, std::size_t words, const std::vector<std::string>& arguments) const {
    const auto children = command.get_subcommands([](const CLI::App*) { return true; });
    if (children.empty()) return;
    for (std::size_t i = words; i < arguments.size(); ++i)
      if (arguments[i] == "-h" || arguments[i] == "--help" || (&command == &app_ && arguments[i] == "--version"))
        return;
    std::vector<std::string> names;
    for (const CLI::App* child : children) names.push_back(child->get_name());
    const std::string called = &command == &app_ ? "mercury" : "mercury " + command.get_name();
    if (words == arguments.size()) throw InputError(fmt::format("no command given; see {} --help", called));
    throw InputError(fmt::format("\"{}\" is not a command{}; see {} --help", arguments[words],
                                 suggestion(arguments[words], names), called));
  }

  void parse(std::vector<std::string> arguments) {
    const auto [command, words] = command_in(arguments);
    require_command(*command, words, arguments);
    if (const std::string path = config_path_in(arguments); !path.empty()) {
      config_.emplace(path, app_, *command, arguments);
      arguments.insert(arguments.begin() + static_cast<std::ptrdiff_t>(words), config_->arguments().begin(),
                       config_->arguments().end());
    }
    require_values(*command, arguments);
    try {
      app_.parse(std::vector<std::string>(arguments.rbegin(), arguments.rend()));
    } catch (const CLI::Success& request) {  // --help or --version
      help_ = true;
      body_ = nullptr;
      if (rank_by_launcher() == 0) app_.exit(request);
    } catch (const CLI::ExtrasError&) {
      throw unknown_argument(*command);
    } catch (const CLI::ArgumentMismatch& error) {
      const std::string what = error.what();
      throw InputError(what.substr(0, what.find(':')), "needs a value; see " + full_name(*command) + " --help");
    } catch (const CLI::ParseError& error) {
      throw InputError(fmt::format("{}; see {} --help", one_line(error.what()), full_name(*command)));
    }
  }

  // CLI11 would read the next argument as the value of "--dt=".
  static void require_values(const CLI::App& command, const std::vector<std::string>& arguments) {
    for (const std::string& argument : arguments)
      if (argument.starts_with("--") && argument.find('=') == argument.size() - 1)
        throw InputError(argument.substr(0, argument.size() - 1),
                         "needs a value; see " + full_name(command) + " --help");
  }

  static std::string full_name(const CLI::App& command) {
    return command.get_parent() ? full_name(*command.get_parent()) + " " + command.get_name() : command.get_name();
  }

  InputError unknown_argument(const CLI::App& command) const {
    const std::vector<std::string> rest = app_.remaining(true);
    const std::string word = rest.empty() ? "" : rest.front().substr(0, rest.front().find('='));
    std::vector<std::string> names;
    for (const CLI::Option* option : command.get_options())
      for (const std::string& name : option->get_lnames()) names.push_back("--" + name);
    return InputError(word, fmt::format("not an option of {}{}; see {} --help", full_name(command),
                                        suggestion(word, names), full_name(command)));
  }

  CLI::App app_{"Mercury simulates soft robots, shows them in a window and makes videos of them.", "mercury"};
  CommandBody body_;
  std::optional<ConfigFile> config_;
  bool help_ = false;
};

}  // namespace

int run_program(const std::vector<std::string>& arguments) {
  catch_interrupts();
  try {
    return Program().run(arguments);
  } catch (const std::exception& error) {
    print_message(error.what());
    return status_failed;
  }
}

}  // namespace mercury
