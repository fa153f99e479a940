// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <bit>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>

#include "mercury/vec3.h"

namespace mercury {

// FNV-1a with 64 bits (Fowler, Noll, Vo), the same on every machine. A change of one byte always changes it.
class Fnv1a {
 public:
  static constexpr std::uint64_t empty = 0xcbf29ce484222325u;
  constexpr explicit Fnv1a(std::uint64_t so_far = empty) : hash_(so_far) {}

  constexpr std::uint64_t value() const { return hash_; }
  // The bytes of a number, the lowest first.
  template <std::unsigned_integral Value>
  constexpr Fnv1a& add(Value value) {
    for (std::size_t i = 0; i < sizeof value; ++i) step(value >> (8 * i) & 0xff);
    return *this;
  }
  constexpr Fnv1a& add(float value) { return add(std::bit_cast<std::uint32_t>(value)); }
  constexpr Fnv1a& add(const Vec3& v) { return add(v.x).add(v.y).add(v.z); }
  constexpr Fnv1a& add(std::string_view bytes) {
    for (const char byte : bytes) step(static_cast<std::uint8_t>(byte));
    return *this;
  }
  constexpr Fnv1a& add(std::span<const std::uint8_t> bytes) {
    for (const std::uint8_t byte : bytes) step(byte);
    return *this;
  }
  // A number in place of a byte: as good for hash tables, and faster.
  constexpr Fnv1a& step(std::uint64_t number) {
    hash_ = (hash_ ^ number) * 0x100000001b3u;
    return *this;
  }

 private:
  std::uint64_t hash_;
};

}  // namespace mercury
