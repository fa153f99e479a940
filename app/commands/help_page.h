// SPDX-License-Identifier: Apache-2.0
// The help of a command, for a terminal.
#pragma once

#include <string>
#include <vector>

#include "app/commands/command_list.h"
#include "app/options/command.h"

namespace mercury {

// Usage, arguments, options by group, explanation and examples, in lines of at most `columns` letters; only words and
// examples that are longer stand out. A `brief` page is one screen: usage, arguments, the options that are declared
// on_first_screen(), and how to see the rest.
std::string help_page(const Command& command, bool brief, int columns);

// Titles of groups of options in the order of the page: what belongs to this command alone first, what all have last.
std::vector<std::string> groups_of(const std::vector<OptionDescription>& options);

// The width of the terminal that standard output is, else COLUMNS, else 80; from 40 to 100.
int columns_of_standard_output();

// The text in lines of at most `columns` letters, broken at spaces; words that are longer break after commas.
std::vector<std::string> wrapped(const std::string& text, std::size_t columns);

}  // namespace mercury
