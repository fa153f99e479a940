// SPDX-License-Identifier: Apache-2.0
// Errors of libraries in words of ours. Errors are described where they arise; this is for those that nobody expected.
#pragma once

#include <exception>
#include <string>

#include "app/options/command.h"

namespace mercury {

// "FILE: No such file or directory" for an error of the file system, no_memory_line() for a failed allocation, else
// the error's own text without the marks of a library.
std::string error_text(const std::exception& error);

// Adds "; did you mean xpbd?" to a message about a mistyped value of an option, such as
// "--solver: \"xpdb\" is not a solver; give force or xpbd".
std::string with_suggestion(const std::string& message, const Command& command);

}  // namespace mercury
