// SPDX-License-Identifier: Apache-2.0
// Origins that hold a network, as JSON.
#pragma once

#include <array>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <map>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "mercury/error.h"

namespace mercury {

// Real numbers are parsed as floats: parsed as doubles and rounded again, the shortest decimals of a float could come
// back one bit off.
using OriginJson = nlohmann::basic_json<std::map, std::vector, std::string, bool, std::int64_t, std::uint64_t, float>;

// The shortest decimals that read back as the same float.
inline void write(std::string& out, float value) {
  std::array<char, 32> room;
  out.append(room.data(), std::to_chars(room.data(), room.data() + room.size(), value).ptr);
  if (value == 0 && std::signbit(value)) out += ".0";  // "-0" would be read as a whole number and lose its sign
}

[[noreturn]] inline void refuse_origin(const std::string& place, const std::string& what) {
  throw InputError("/origin" + place, what);
}

// Throws InputError if it is missing.
inline const OriginJson& origin_member(const OriginJson& origin, const char* key) {
  const auto found = origin.find(key);
  if (found == origin.end()) refuse_origin(std::string("/") + key, "is missing");
  return *found;
}

// Empty if it is missing or no text.
inline std::string text_in(const OriginJson& origin, const char* key) {
  const auto found = origin.find(key);
  return found != origin.end() && found->is_string() ? found->get<std::string>() : std::string();
}

}  // namespace mercury
