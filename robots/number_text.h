// SPDX-License-Identifier: Apache-2.0
// Numbers as text, the same on every machine and in every language.
#pragma once

#include <concepts>
#include <cstdint>
#include <string>

namespace mercury {

// The shortest decimal that reads back as the same number: "0.2", "1e+20", "inf", "-inf", "nan".
std::string shortest_text(double value);
// The same for a float, also where it is read as a double and then rounded.
std::string shortest_text(float value);
template <std::integral Whole>
std::string shortest_text(Whole value) {
  return std::to_string(value);
}

// With that many digits after the point: "3.14".
std::string fixed_text(double value, int digits);

// With commas between thousands: "12,000".
std::string with_commas(std::uint64_t number);

}  // namespace mercury
