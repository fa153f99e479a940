// SPDX-License-Identifier: Apache-2.0
#include "app/window/toolkit/fuzzy_match.h"

#include <algorithm>
#include <limits>
#include <vector>

namespace mercury::window {
namespace {

char lower(char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c; }

bool begins_word(std::string_view text, std::size_t i) {
  const auto is_part = [](char c) { return (lower(c) >= 'a' && c != ' ') || (c >= '0' && c <= '9') || c < 0; };
  return i == 0 || !is_part(text[i - 1]);
}

}  // namespace

// best[i]: the best score of the query so far with its last letter at text[i].
std::optional<int> fuzzy_match(std::string_view query, std::string_view text) {
  constexpr int none = std::numeric_limits<int>::min();
  constexpr std::size_t most = 256;  // letters; what lies after is not searched
  text = text.substr(0, most);
  std::vector<int> best, next(text.size());
  for (const char letter : query.substr(0, most)) {
    if (letter == ' ') continue;
    if (text.empty()) return std::nullopt;
    int reachable = best.empty() ? 0 : none;  // the best score that ends before text[i - 1]
    const bool first = best.empty();
    for (std::size_t i = 0; i < text.size(); ++i) {
      if (!first && i >= 2) reachable = std::max(reachable, best[i - 2]);
      const int beside = !first && i >= 1 && best[i - 1] != none ? best[i - 1] + 6 : none;
      const int from = std::max(beside, reachable);
      const bool same = lower(letter) == lower(text[i]) && from != none;
      next[i] = same ? from + 1 + (begins_word(text, i) ? 5 : 0) : none;
    }
    best = next;
  }
  if (best.empty()) return 0;
  const int score = *std::ranges::max_element(best);
  if (score == none) return std::nullopt;
  return 8 * score - static_cast<int>(text.size());
}

}  // namespace mercury::window
