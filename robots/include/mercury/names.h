// SPDX-License-Identifier: Apache-2.0
// Names in messages: lists of the accepted ones, and the one that is nearest to a mistyped one.
#pragma once

#include <string>
#include <vector>

namespace mercury {

// "a, b, c"; with `last` = " or ": "a, b or c".
std::string list_of(const std::vector<std::string>& names, const char* last = ", ");

// Returns "; did you mean --seconds?", or an empty string when no name is near.
std::string suggestion(const std::string& word, const std::vector<std::string>& names);

}  // namespace mercury
