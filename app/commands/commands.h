// SPDX-License-Identifier: Apache-2.0
// What a command of the program is made of. Each has a source file of its own; program.cpp lists them.
#pragma once

#include <functional>

#include "app/options/command.h"

namespace mercury {

// Runs a command after its options were parsed. Returns the exit status. Throws InputError (exit status 2) or another
// std::exception (exit status 1).
using CommandBody = std::function<int()>;

// Receives the command that the user chose.
using Choose = std::function<void(CommandBody)>;

// Adds a command to the program. Parsing the command line calls `choose`.
using AddCommand = void(const Command& program, const Choose& choose);

}  // namespace mercury
