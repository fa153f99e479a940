// SPDX-License-Identifier: Apache-2.0
// Completion scripts for shells, made from the list of commands. They complete commands, options, words that options
// accept, and files with the right endings.
#pragma once

#include <string>
#include <vector>

#include "app/commands/command_list.h"

namespace mercury {

std::string bash_completion(const std::vector<CommandDescription>& commands);
std::string zsh_completion(const std::vector<CommandDescription>& commands);
std::string fish_completion(const std::vector<CommandDescription>& commands);

}  // namespace mercury
