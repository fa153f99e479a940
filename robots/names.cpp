// SPDX-License-Identifier: Apache-2.0
#include "mercury/names.h"

#include <algorithm>
#include <array>
#include <cstdio>
#include <numeric>

namespace mercury {
namespace {

constexpr std::size_t longest_word = 100;  // nobody means a longer one; the search takes its square

// The number of letters to insert, delete or replace to get from a to b. A swap of neighbors counts as one change
// (optimal string alignment).
std::size_t distance(const std::string& a, const std::string& b) {
  std::vector<std::size_t> before, row(b.size() + 1), next(b.size() + 1);
  std::iota(row.begin(), row.end(), 0u);
  for (std::size_t i = 1; i <= a.size(); ++i) {
    next[0] = i;
    for (std::size_t j = 1; j <= b.size(); ++j) {
      next[j] = std::min({row[j] + 1, next[j - 1] + 1, row[j - 1] + (a[i - 1] != b[j - 1])});
      if (i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1])
        next[j] = std::min(next[j], before[j - 2] + 1);
    }
    before = row;
    row.swap(next);
  }
  return row[b.size()];
}

}  // namespace

std::string list_of(const std::vector<std::string>& names, const char* last) {
  std::string list;
  for (std::size_t i = 0; i < names.size(); ++i) list += (i == 0 ? "" : i + 1 == names.size() ? last : ", ") + names[i];
  return list;
}

std::string toml_text(std::string_view text) {
  std::string quote = "\"";
  for (const char letter : text) {
    const auto byte = static_cast<unsigned char>(letter);
    if (letter == '"' || letter == '\\') {
      quote.append({'\\', letter});
    } else if (byte < 0x20 || byte == 0x7f) {
      char code[8];
      std::snprintf(code, sizeof code, "\\u%04x", byte);
      quote += code;
    } else {
      quote += letter;
    }
  }
  return quote + '"';
}

std::string markup_text(std::string_view text) {
  std::string safe;
  for (const char letter : text) {
    if (const std::size_t at = std::string_view("&<>\"").find(letter); at != std::string_view::npos)
      safe += std::array{"&amp;", "&lt;", "&gt;", "&quot;"}[at];
    else if (static_cast<unsigned char>(letter) >= ' ' || letter == '\t' || letter == '\n')
      safe += letter;
  }
  return safe;
}

std::string suggestion(const std::string& word, const std::vector<std::string>& names) {
  if (word.size() > longest_word) return {};
  std::string nearest;
  std::size_t least = std::max<std::size_t>(1, word.size() / 3) + 1;
  for (const std::string& name : names) {
    const bool begins = word.size() >= 4 && name.starts_with(word);
    const std::size_t changes = begins ? 0 : distance(word, name);
    if (changes < least) {
      least = changes;
      nearest = name;
    }
  }
  return nearest.empty() ? "" : "; did you mean " + nearest + "?";
}

}  // namespace mercury
