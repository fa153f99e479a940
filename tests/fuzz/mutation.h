// SPDX-License-Identifier: Apache-2.0
// Damages documents, the same way for the same random numbers.
#pragma once

#include <algorithm>
#include <string>
#include <string_view>

#include "mercury/random.h"

namespace mercury::fuzz {

inline std::string mutated(std::string document, std::string_view other, Random& random) {
  const auto place = [&] { return static_cast<std::size_t>(random.below(document.size())); };
  constexpr std::string_view pieces[] = {"[",    "]",
                                         "{",    "}",
                                         ",",    ":",
                                         "\"",   "-",
                                         "=",    "1e9",
                                         "null", "0.0",
                                         "nan",  "true",
                                         "\n",   "1e999",
                                         "\x9f", "\xbf",
                                         "\xff", "\x1b",
                                         "\x7f", "\xf9",
                                         "\xc1", "\\u",
                                         "\\",   "99999999999999999999"};
  const auto edits = 1 + random.below(4);
  for (std::uint64_t edit = 0; edit < edits && !document.empty(); ++edit) {
    const std::size_t at = place(), length = 1 + static_cast<std::size_t>(random.below(16));
    switch (random.below(8)) {
      case 0:
        document[at] = static_cast<char>(random.below(256));
        break;
      case 1:
        document[at] = static_cast<char>(document[at] ^ (1 << random.below(8)));
        break;
      case 2:
        document.erase(at, length);
        break;
      case 3:
        document.insert(at, pieces[random.below(std::size(pieces))]);
        break;
      case 4:
        document.insert(at, document.substr(place(), length));
        break;
      case 5:
        document.insert(at, other.substr(static_cast<std::size_t>(random.below(other.size() + 1)), 4 * length));
        break;
      case 6:
        std::fill_n(document.begin() + static_cast<std::ptrdiff_t>(at), std::min(length, document.size() - at),
                    random.chance(0.5) ? '\xff' : '\0');
        break;
      default:
        document.resize(at);
        break;
    }
  }
  return document;
}

}  // namespace mercury::fuzz
