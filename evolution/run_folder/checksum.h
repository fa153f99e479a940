// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string_view>

namespace mercury {

// FNV-1a (Fowler, Noll, Vo). A change of one byte always changes it.
inline constexpr std::uint64_t empty_checksum = 0xcbf29ce484222325u;
constexpr std::uint64_t checksum_of(std::string_view bytes, std::uint64_t so_far = empty_checksum) {
  for (const char byte : bytes) so_far = (so_far ^ static_cast<std::uint8_t>(byte)) * 0x100000001b3u;
  return so_far;
}

constexpr std::uint32_t short_checksum_of(std::string_view bytes) {
  const std::uint64_t checksum = checksum_of(bytes);
  return static_cast<std::uint32_t>(checksum ^ checksum >> 32);
}

}  // namespace mercury
