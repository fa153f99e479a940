// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <bit>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>

#include "mercury/random.h"

namespace mercury {

// Adds up what makes a genome's robot what it is: FNV-1a over bytes, mixed at the end.
class IdentityHash {
 public:
  template <std::unsigned_integral Value>
  void add(Value value) {
    for (std::size_t i = 0; i < sizeof value; ++i) add_byte(static_cast<std::uint8_t>(value >> (8 * i) & 0xff));
  }
  void add(float value) { add(std::bit_cast<std::uint32_t>(value)); }
  void add(std::string_view bytes) {
    for (const char byte : bytes) add_byte(static_cast<std::uint8_t>(byte));
  }
  void add(std::span<const std::uint8_t> bytes) {
    for (const std::uint8_t byte : bytes) add_byte(byte);
  }
  std::uint64_t value() const { return seed_of(hash_, 0); }

 private:
  void add_byte(std::uint8_t byte) { hash_ = (hash_ ^ byte) * 1099511628211u; }

  std::uint64_t hash_ = 14695981039346656037u;
};

}  // namespace mercury
