// SPDX-License-Identifier: Apache-2.0
// The program `mercury`: runs a command line and returns the exit status. Options may stand before the name of the
// command. Errors are described where they arise; error_text() is for those of libraries that nobody expected.
#pragma once

#include <exception>
#include <string>
#include <vector>

#include "app/options/command.h"

namespace mercury {

inline constexpr int status_done = 0;
inline constexpr int status_failed = 1;
inline constexpr int status_bad_input = 2;

// Runs one command. Prints results to standard output and messages to standard error, one line per error.
int run_program(const std::vector<std::string>& arguments);

// "FILE: No such file or directory" for an error of the file system, no_memory_line() for a failed allocation, else
// the error's own text without the marks of a library.
std::string error_text(const std::exception& error);

// Adds "; did you mean xpbd?" to a message about a mistyped value of an option, such as
// "--solver: \"xpdb\" is not a solver; give force or xpbd".
std::string with_suggestion(const std::string& message, const Command& command);

// A command line with the words of its command in front.
struct CommandLine {
  Command command;        // which the words name; the program itself if there are none
  std::size_t words = 0;  // leading arguments that name the command
  std::vector<std::string> arguments;
};

// "--dt 0.001 run x.json" becomes "run --dt 0.001 x.json"; "help run" becomes "run --help". Throws InputError for a
// word that is not a command, or an option before the command that no command has, or if there is no command where one
// is needed.
CommandLine command_line(const Command& program, std::vector<std::string> arguments);

// The names of the subcommands that help shows.
std::vector<std::string> names_of_commands(const Command& command);

// The names of the options of a command ("--dt"), and of all commands below it if `below`.
std::vector<std::string> names_of_options(const Command& command, bool below = false);

}  // namespace mercury
