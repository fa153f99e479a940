// SPDX-License-Identifier: Apache-2.0
#include "app/commands/description.h"

#include <fmt/format.h>

#include "app/base/messages.h"

namespace mercury {

void print_heading(const std::string& text) { fmt::print("{}\n", printable(text)); }

void print_line(const std::string& what, const std::string& text) { fmt::print("  {:<12}{}\n", what, printable(text)); }

}  // namespace mercury
