// SPDX-License-Identifier: Apache-2.0
// The program `mercury`: runs a command line and returns the exit status.
#pragma once

#include <string>
#include <vector>

namespace mercury {

inline constexpr int status_done = 0;
inline constexpr int status_failed = 1;
inline constexpr int status_bad_input = 2;

// Runs one command. Prints results to standard output and messages to standard error, one line per error.
int run_program(const std::vector<std::string>& arguments);

}  // namespace mercury
