// SPDX-License-Identifier: Apache-2.0
// A question to the user.
#pragma once

#include <string>

namespace mercury {

// Whether there is somebody to ask: standard input and standard error are terminals.
bool can_ask();

// Prints "mercury: QUESTION [y/N] " and waits for a line. True for "y" and "yes". Throws Interrupted at
// Ctrl-C.
bool ask(const std::string& question);

}  // namespace mercury
