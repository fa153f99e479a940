// SPDX-License-Identifier: Apache-2.0
// Lines of CSV (RFC 4180).
#pragma once

#include <concepts>
#include <string>
#include <string_view>
#include <vector>

#include "robots/number_text.h"

namespace mercury {

// A text as a field: in quotes where the standard requires them.
inline std::string csv_field(std::string_view text) {
  if (text.find_first_of(",\"\n\r") == std::string_view::npos) return std::string(text);
  std::string field = "\"";
  for (const char letter : text) field.append(letter == '"' ? 2 : 1, letter);
  return field + '"';
}

class CsvLines {
 public:
  CsvLines& cell(std::string_view text) {
    if (!at_line_start_) text_ += ',';
    at_line_start_ = false;
    text_ += csv_field(text);
    return *this;
  }
  CsvLines& cell(double value) { return cell(shortest_text(value)); }
  template <std::integral Whole>
  CsvLines& cell(Whole value) {
    return cell(std::to_string(value));
  }
  void end_line() {
    text_ += '\n';
    at_line_start_ = true;
  }
  const std::string& text() const { return text_; }

 private:
  std::string text_;
  bool at_line_start_ = true;
};

// The fields of one line.
inline std::vector<std::string> csv_fields(std::string_view line) {
  std::vector<std::string> fields(1);
  bool is_quoted = false;
  for (std::size_t i = 0; i < line.size(); ++i) {
    if (line[i] == '"') {
      const bool is_letter = is_quoted && i + 1 < line.size() && line[i + 1] == '"';
      if (is_letter)
        fields.back() += line[i++];
      else
        is_quoted = !is_quoted;
    } else if (line[i] == ',' && !is_quoted) {
      fields.emplace_back();
    } else {
      fields.back() += line[i];
    }
  }
  return fields;
}

}  // namespace mercury
