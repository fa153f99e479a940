// SPDX-License-Identifier: Apache-2.0
// "did you mean": the name nearest to a mistyped one.
#pragma once

#include <string>
#include <vector>

namespace mercury {

// "; did you mean --seconds?", or nothing when no name is near.
std::string suggestion(const std::string& word, const std::vector<std::string>& names);

}  // namespace mercury
