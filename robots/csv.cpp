// SPDX-License-Identifier: Apache-2.0
#include "mercury/csv.h"

#include "mercury/number_text.h"

namespace mercury {

std::string csv_field(std::string_view text) {
  if (text.find_first_of(",\"\n\r") == std::string_view::npos) return std::string(text);
  std::string field = "\"";
  for (const char letter : text) field.append(letter == '"' ? 2 : 1, letter);
  return field + '"';
}

CsvLines& CsvLines::cell(double value) { return cell(shortest_text(value)); }

std::vector<std::string> csv_fields(std::string_view line) {
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
