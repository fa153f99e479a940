// SPDX-License-Identifier: Apache-2.0
// Names in messages: lists of the accepted ones, and the one that is nearest to a mistyped one. Texts in documents.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace mercury {

// "a, b, c"; with `last` = " or ": "a, b or c".
std::string list_of(const std::vector<std::string>& names, const char* last = ", ");

// Returns "; did you mean --seconds?", or an empty string when no name is near.
std::string suggestion(const std::string& word, const std::vector<std::string>& names);

// The text in quotes, as TOML has it.
std::string toml_text(std::string_view text);

// The text within HTML or XML: markup and quotes as entities, without control characters but tabs and line ends.
std::string markup_text(std::string_view text);

}  // namespace mercury
