// SPDX-License-Identifier: Apache-2.0
// Finds texts by some of their letters.
#pragma once

#include <optional>
#include <string_view>

namespace mercury::window {

// How well a text fits a query: higher is better; none if a letter of the query is missing. Letters of the query must
// appear in order, in any case; blanks of the query are ignored. Letters that follow each other or begin a word count
// more, and a text that has little beside the query comes first. An empty query fits everything equally.
std::optional<int> fuzzy_match(std::string_view query, std::string_view text);

}  // namespace mercury::window
