// SPDX-License-Identifier: Apache-2.0
// Numbers as text and back, the same on every machine and in every language.
#pragma once

#include <charconv>
#include <concepts>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <system_error>

namespace mercury {

// The double with the shortest decimal that converts back to this float: 0.2, not 0.20000000298023224.
double shortest(float value);

// The shortest decimal that reads back as the same number: "0.2", "1e+20", "inf", "-inf", "nan".
std::string shortest_text(double value);
// The same for a float, also where it is read as a double and then rounded.
std::string shortest_text(float value);
template <std::integral Whole>
std::string shortest_text(Whole value) {
  return std::to_string(value);
}

// The number that the whole text is; none for another text, or one out of range. `form` as of std::from_chars: the base
// of a whole number.
template <class Number>
std::optional<Number> parse_number(std::string_view text, auto... form) {
  Number number{};
  const char* const all = text.data() + text.size();
  const auto [end, error] = std::from_chars(text.data(), all, number, form...);
  return error == std::errc{} && end == all ? std::optional(number) : std::nullopt;
}

// With that many digits after the point: "3.14".
std::string fixed_text(double value, int digits);

// With commas between thousands: "12,000".
std::string with_commas(std::uint64_t number);

}  // namespace mercury
