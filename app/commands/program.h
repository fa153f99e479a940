// SPDX-License-Identifier: Apache-2.0
// The program `mercury`: from a command line to an exit status.
#pragma once

#include <string>
#include <vector>

namespace mercury {

inline constexpr int status_done = 0;
inline constexpr int status_failed = 1;
inline constexpr int status_bad_input = 2;

// Runs one command. Results go to standard output, messages to standard error, one line an error.
int run_program(const std::vector<std::string>& arguments);

}  // namespace mercury
