// SPDX-License-Identifier: Apache-2.0
#include "robots/document.h"

#include <array>
#include <charconv>
#include <cmath>
#include <limits>

namespace mercury {

std::optional<float> to_float(const Number& number) {
  if (number.text.empty()) {
    // A double beyond the largest float may round to it, as it does in a JSON text.
    const auto value = static_cast<float>(std::abs(number.real) < 0x1.ffffffp127 ? number.real : HUGE_VAL);
    if (std::isfinite(number.real) && std::isfinite(value)) return value;
    return std::nullopt;
  }
  float value = 0;
  const char* end = number.text.data() + number.text.size();
  const auto [parsed, error] = std::from_chars(number.text.data(), end, value);
  if (error == std::errc{} && parsed == end && std::isfinite(value)) return value;
  // from_chars also reports "out of range" for numbers that are too small.
  if (error == std::errc::result_out_of_range && std::abs(number.real) < 1) return 0.f;
  return std::nullopt;
}

std::string to_text(const Number& number) {
  if (number.kind == Number::Kind::natural) return std::to_string(number.natural);
  if (number.kind == Number::Kind::negative) return std::to_string(number.negative);
  if (!number.text.empty()) return std::string(number.text);
  std::array<char, 32> room;
  const auto end = std::to_chars(room.data(), room.data() + room.size(), number.real).ptr;
  std::string text(room.data(), end);
  // Without a point or an exponent it would be read back as a whole number.
  if (text.find_first_of(".e") == std::string::npos) text += ".0";
  return text;
}

Number natural_number(std::uint64_t value) {
  return {.kind = Number::Kind::natural, .natural = value, .real = static_cast<double>(value)};
}

Number real_number(float value, std::span<char> room) {
  Number number{.kind = Number::Kind::real, .real = static_cast<double>(value)};
  const auto end = std::to_chars(room.data(), room.data() + room.size(), value).ptr;
  number.text = {room.data(), static_cast<std::size_t>(end - room.data())};
  if (number.text == "-0") number.text = "-0.0";  // JSON's "-0" is a whole number, and has no sign
  return number;
}

}  // namespace mercury
