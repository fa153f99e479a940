// SPDX-License-Identifier: Apache-2.0
#include "mercury/number_text.h"

#include <cmath>

namespace mercury {

double shortest(float value) {
  char text[40];
  const char* const end = std::to_chars(text, text + sizeof text, value).ptr;
  double number = value;
  std::from_chars(text, end, number);
  return static_cast<float>(number) == value ? number : static_cast<double>(value);
}

std::string shortest_text(double value) {
  if (std::isnan(value)) return "nan";
  char text[40];
  return {text, std::to_chars(text, text + sizeof text, value).ptr};
}

std::string shortest_text(float value) { return shortest_text(shortest(value)); }

std::string fixed_text(double value, int digits) {
  char text[400];
  const auto result = std::to_chars(text, text + sizeof text, value, std::chars_format::fixed, digits);
  return {text, result.ptr};
}

std::string with_commas(std::uint64_t number) {
  std::string text = std::to_string(number);
  for (std::size_t at = text.size(); at > 3; at -= 3) text.insert(at - 3, 1, ',');
  return text;
}

}  // namespace mercury
