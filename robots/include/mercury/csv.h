// SPDX-License-Identifier: Apache-2.0
// Lines of CSV (RFC 4180).
#pragma once

#include <concepts>
#include <string>
#include <string_view>
#include <vector>

namespace mercury {

// A text as a field: in quotes where the standard requires them.
std::string csv_field(std::string_view text);

class CsvLines {
 public:
  CsvLines& cell(std::string_view text) {
    if (!at_line_start_) text_ += ',';
    at_line_start_ = false;
    text_ += csv_field(text);
    return *this;
  }
  CsvLines& cell(double value);
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
std::vector<std::string> csv_fields(std::string_view line);

}  // namespace mercury
