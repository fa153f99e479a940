// SPDX-License-Identifier: Apache-2.0
// The order of a command line: options may stand before the name of the command.
#pragma once

#include <string>
#include <vector>

#include "app/options/command.h"

namespace mercury {

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
