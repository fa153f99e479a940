// SPDX-License-Identifier: Apache-2.0
// Lines for people on standard error. None of these functions fails: what cannot be written is dropped, because results
// count more than messages.
#pragma once

#include <string>
#include <string_view>

namespace mercury {

enum class Verbosity { quiet, normal, verbose };

// Of the whole program; normal until it is set.
void set_verbosity(Verbosity verbosity);
Verbosity verbosity();

// "mercury: TEXT", always: what went wrong, or what the user would miss.
void warn(std::string_view text);
// The same, unless the program is quiet: what is done.
void say(std::string_view text);
// The same, only if the program is verbose.
void say_detail(std::string_view text);

// Writes text as it is, for bars on a terminal.
void write_to_standard_error(std::string_view text);

// The text as one line that a terminal shows without obeying it: control characters, direction marks and bytes that are
// not UTF-8 become \n, \x1b, \u202e or \xff. A text longer than `longest` bytes loses its middle; its ends stay.
std::string printable(std::string_view text, std::size_t longest = 800);

// Length of the well-formed UTF-8 character at the beginning of `text` [bytes]; 0 = it is not one.
std::size_t utf8_length(std::string_view text);

}  // namespace mercury
