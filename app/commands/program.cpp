// SPDX-License-Identifier: Apache-2.0
#include "app/commands/program.h"

#include <fmt/format.h>
#include <sys/resource.h>
#include <CLI/CLI.hpp>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <exception>
#include <optional>
#include <system_error>
#include <thread>

#include "app/base/interrupt.h"
#include "app/base/messages.h"
#include "app/base/standard_streams.h"
#include "app/base/suggestion.h"
#include "app/base/version.h"
#include "app/commands/command_line.h"
#include "app/commands/commands.h"
#include "app/commands/error_text.h"
#include "app/commands/help_page.h"
#include "app/options/config_file.h"
#include "app/options/option_values.h"
#include "app/options/scene_file.h"
#include "evolution/distribution/launcher.h"
#include "mercury/error.h"

namespace mercury {
namespace {

constexpr const char* footer =
    "Options may stand before or behind the name of the command, and in a file for --config.\n\n"
    "Examples:\n"
    "  mercury view                                       the sample robots in a window\n"
    "  mercury render --random voxel:12 -o group.mp4      a video of twelve random robots\n"
    "  mercury run --random voxel:64 --seconds 2          simulate and print the results\n"
    "  mercury new voxel --count 10 -o my-robots          make robot files\n"
    "  mercury run my-robots --environment land           simulate them on land\n"
    "  mercury export eel.json -o eel.glb                 a robot for other programs\n"
    "  mercury info                                       what this machine can do\n"
    "  mercury help render                                all options of a command\n\n"
    "Exit status: 0 = done; 1 = the work failed, or robots were left out; 2 = the input cannot be used;\n"
    "128 + N = stopped by signal N (130 for Ctrl-C).";

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

// Values of text options that may be empty. For all others an empty text is a mistake: a variable that a script did not
// set.
bool may_be_empty(const CLI::Option& option) { return option.check_lname("caption"); }

class Program {
 public:
  Program() {
    app_.footer(footer);
    app_.set_help_flag("-h,--help", "Print help: -h the most used options, --help all");
    const Choose choose = [this](CommandBody body) { body_ = std::move(body); };
    add_view_command(app_, choose);
    add_render_command(app_, choose);
    add_run_command(app_, choose);
    add_evolve_command(app_, choose);
    add_new_command(app_, choose);
    add_mutate_command(app_, choose);
    add_cross_command(app_, choose);
    add_grow_command(app_, choose);
    add_export_command(app_, choose);
    add_import_command(app_, choose);
    add_bench_command(app_, choose);
    add_verify_command(app_, choose);
    add_info_command(app_, choose);
    add_help_command();
    add_describe_command(app_, choose);
    add_general_options(app_);
  }

  int run(std::vector<std::string> arguments) {
    const auto start = std::chrono::steady_clock::now();
    try {
      parse(std::move(arguments));
      if (body_) say_detail(fmt::format("{}: {}", program_version, full_name(*command_)));
      int status = body_ ? body_() : status_done;
      if (status == status_failed && interrupted()) status = stopped_status();
      flush_standard_output();
      if (body_) say_costs(std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count());
      return status;
    } catch (const ParameterError& error) {
      return refuse(option_of(error.parameter()) + ": " + error.problem());
    } catch (const InputError& error) {
      return refuse(error.what());
    } catch (const Interrupted&) {
      say("stopped");
      return stopped_status();
    } catch (const std::system_error& error) {
      // A result that was longer than the buffer fails while it is printed.
      print_message(std::ferror(stdout) ? "standard output cannot be written: " + error.code().message()
                                        : error_text(error));
      return interrupted() ? stopped_status() : status_failed;
    } catch (const std::exception& error) {
      print_message(error_text(error));
      return interrupted() ? stopped_status() : status_failed;
    }
  }

 private:
  void add_help_command() {
    // command_line() puts --help behind the words instead.
    CLI::App* command = app_.add_subcommand("help", "Explain a command, as in mercury help new voxel");
    offer(command->add_option("COMMAND", words_of_help_, "A command, and the kind of robots of new"),
          names_of_commands(app_));
  }

  // The options that every command has, and --config.
  void add_general_options(CLI::App& command) {
    const auto add = [](CLI::Option* option) { option->group("General"); };
    add(command.get_help_ptr());
    add(command.set_version_flag("-V,--version", program_version, "Print the version"));
    add(command.add_flag("-q,--quiet", quiet_, "Print only errors and warnings on standard error"));
    add(command.add_flag("-v,--verbose", verbose_, "Say in detail what is done, with times"));
    const auto children = command.get_subcommands([](CLI::App*) { return true; });
    if (children.empty())
      add(add_text(command, "--config", config_path_,
                   "Read options from a TOML file; the command line overrides them (docs/command-line.md)",
                   "FILE.toml"));
    for (CLI::App* child : children) add_general_options(*child);
  }

  int refuse(const std::string& message) const {
    const std::string helpful = command_ ? with_suggestion(message, *command_) : message;
    print_message(located(config_ ? config_->located(helpful) : helpful));
    return status_bad_input;
  }

  // With the line of the scene if the error names an option that came from there.
  std::string located(const std::string& error) const {
    const std::string name = error.substr(0, error.find(':'));
    const bool from_scene = std::ranges::any_of(
        scene_options_, [&](const std::string& option) { return option.substr(0, option.find('=')) == name; });
    return from_scene ? scene_->located(error) : error;
  }

  // Puts the robots and the options of a scene in its place among the robots of a command.
  void expand_scene(const CLI::App& command, std::size_t words, std::vector<std::string>& arguments) {
    // `info` describes the scene itself.
    if (!command.get_option_no_throw("ROBOTS") || command.get_name() == "info") return;
    const std::vector<std::size_t> places = scenes_in(command, words, arguments);
    if (places.empty()) return;
    if (places.size() > 1) throw InputError(arguments[places[1]], "is a second scene; give one");
    scene_.emplace(arguments[places.front()]);
    if (!scene_->random().empty() && !command.get_option_no_throw("--random"))
      throw InputError(scene_->path().string(),
                       fmt::format("has random robots, which {} does not take; give robot files", full_name(command)));
    if (!scene_->attached().empty() && !command.get_option_no_throw("--attach"))
      warn(fmt::format("{}: pins and attached springs are left out; only mercury view has them",
                       scene_->path().string()));
    scene_options_ = scene_->arguments(command, arguments);
    const auto place = arguments.erase(arguments.begin() + static_cast<std::ptrdiff_t>(places.front()));
    arguments.insert(place, scene_->robots().begin(), scene_->robots().end());
    arguments.insert(arguments.begin() + static_cast<std::ptrdiff_t>(words), scene_options_.begin(),
                     scene_options_.end());
  }

  // Which arguments are scenes, and no values of options.
  static std::vector<std::size_t> scenes_in(const CLI::App& command, std::size_t words,
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
      const CLI::Option* option = command.get_option_no_throw(argument);
      if (option && option->get_items_expected_max() > 0) ++i;
    }
    return places;
  }

  void parse(std::vector<std::string> given) {
    auto [command, words, arguments] = command_line(app_, std::move(given));
    command_ = command;
    if (const std::string path = config_path_in(arguments); !path.empty()) {
      config_.emplace(path, app_, *command, arguments);
      arguments.insert(arguments.begin() + static_cast<std::ptrdiff_t>(words), config_->arguments().begin(),
                       config_->arguments().end());
    }
    expand_scene(*command, words, arguments);
    require_values(*command, arguments);
    try {
      app_.parse(std::vector<std::string>(arguments.rbegin(), arguments.rend()));
    } catch (const CLI::Success& request) {
      body_ = nullptr;
      if (rank_by_launcher() == 0) answer(request, *command, arguments);
    } catch (const CLI::ExtrasError&) {
      throw unknown_argument(*command);
    } catch (const CLI::ArgumentMismatch& error) {
      const std::string what = error.what();
      throw InputError(what.substr(0, what.find(':')), "needs a value; see " + full_name(*command) + " --help");
    } catch (const CLI::ParseError& error) {
      throw InputError(fmt::format("{}; see {} --help", error.what(), full_name(*command)));
    }
    set_verbosity(quiet_ ? Verbosity::quiet : verbose_ ? Verbosity::verbose : Verbosity::normal);
    if (body_) require_texts(*command);
    if (config_) say_detail("options from " + config_path_);
  }

  // Prints help or version.
  static void answer(const CLI::Success& request, const CLI::App& command, const std::vector<std::string>& arguments) {
    if (request.get_name() == "CallForVersion") {
      fmt::print("{}\n", program_version);
      return;
    }
    const bool brief = std::ranges::find(arguments, "-h") != arguments.end() &&
                       std::ranges::find(arguments, "--help") == arguments.end();
    fmt::print("{}", help_page(command, brief, columns_of_standard_output()));
  }

  // CLI11 would read the next argument as the value of "--dt=", and the value of a switch in its own way.
  static void require_values(const CLI::App& command, const std::vector<std::string>& arguments) {
    for (const std::string& argument : arguments) {
      if (argument == "--") return;
      const std::size_t equals = argument.find('=');
      if (!argument.starts_with("--") || equals == std::string::npos) continue;
      const std::string name = argument.substr(0, equals);
      const CLI::Option* option = command.get_option_no_throw(name);
      if (option && option->get_items_expected_max() == 0)
        throw InputError(name, "is a switch; give it without a value");
      if (equals == argument.size() - 1 && !(option && may_be_empty(*option))) throw empty_value(name, command);
    }
  }

  static void require_texts(const CLI::App& command) {
    for (const CLI::Option* option : command.get_options()) {
      const std::vector<std::string>& texts = option->results();
      if (option->get_items_expected_max() == 0 || may_be_empty(*option)) continue;
      if (std::ranges::find(texts, "") == texts.end()) continue;
      throw empty_value(option->get_positional() ? option->get_single_name() : first_name(*option), command);
    }
  }

  // As add_value() names it in messages: "-o" of "-o,--output".
  static std::string first_name(const CLI::Option& option) {
    return option.get_snames().empty() ? "--" + option.get_single_name() : "-" + option.get_snames().front();
  }

  static InputError empty_value(const std::string& name, const CLI::App& command) {
    const CLI::Option* option = command.get_option_no_throw(name);
    const std::string form = option ? option->get_type_name() : "";
    return InputError(name, fmt::format("an empty value is not accepted; give {}, or leave {} out",
                                        form.empty() ? "a value" : form, name.starts_with("-") ? "the option" : "it"));
  }

  InputError unknown_argument(const CLI::App& command) const {
    const std::vector<std::string> rest = app_.remaining(true);
    const std::string word = rest.empty() ? "" : rest.front().substr(0, rest.front().find('='));
    if (!word.starts_with("-"))
      return InputError(printable(word, 200), fmt::format("one argument too many; see {} --help", full_name(command)));
    return InputError(printable(word, 200),
                      fmt::format("not an option of {}{}; see {} --help", full_name(command),
                                  suggestion(word, names_of_options(command)), full_name(command)));
  }

  static void say_costs(double seconds) {
    rusage usage{};
    getrusage(RUSAGE_SELF, &usage);
    say_detail(fmt::format("took {:.2f} s, at most {:.0f} MB of memory", seconds,
                           static_cast<double>(usage.ru_maxrss) / 1024));
  }

  CLI::App app_{"Mercury simulates soft robots, shows them in a window and makes videos of them.", "mercury"};
  CommandBody body_;
  const CLI::App* command_ = nullptr;  // that the command line names
  std::optional<ConfigFile> config_;
  std::optional<SceneFile> scene_;
  std::vector<std::string> scene_options_;  // "--dt=0.002": those that the command took from the scene
  bool quiet_ = false, verbose_ = false;
  std::string config_path_;  // config_path_in() reads it earlier
  std::vector<std::string> words_of_help_;
};

}  // namespace

int run_program(const std::vector<std::string>& arguments) {
  replace_closed_streams();
  catch_interrupts();
  try {
    return Program().run(arguments);
  } catch (const std::exception& error) {
    print_message(error_text(error));
    return status_failed;
  }
}

}  // namespace mercury
