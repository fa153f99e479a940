// SPDX-License-Identifier: Apache-2.0
// Words of a command line.
#pragma once

#include <string>

namespace mercury {

// A word for the shell, in quotes if it needs them.
std::string shell_quoted(const std::string& word);

}  // namespace mercury
