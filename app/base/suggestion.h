// SPDX-License-Identifier: Apache-2.0
// "did you mean ...?": finds the name that is nearest to a mistyped one.
#pragma once

#include <string>
#include <vector>

namespace mercury {

// Returns "; did you mean --seconds?", or an empty string when no name is near.
std::string suggestion(const std::string& word, const std::vector<std::string>& names);

}  // namespace mercury
