// SPDX-License-Identifier: Apache-2.0
// Genomes as bytes: little-endian on every machine, and safe to read from a damaged file.
#pragma once

#include <bit>
#include <concepts>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>

namespace mercury {

class ByteWriter {
 public:
  // A whole number in as many bytes as it has, or the bits of a float or double.
  template <std::unsigned_integral Value>
  void add(Value value) {
    for (std::size_t i = 0; i < sizeof value; ++i) bytes_ += static_cast<char>(value >> (8 * i) & 0xff);
  }
  void add(float value) { add(std::bit_cast<std::uint32_t>(value)); }
  void add(double value) { add(std::bit_cast<std::uint64_t>(value)); }
  void add(std::span<const std::uint8_t> values) {
    bytes_.append(reinterpret_cast<const char*>(values.data()), values.size());
  }
  std::string take() && { return std::move(bytes_); }

 private:
  std::string bytes_;
};

// Throws InputError("genome", ...) where bytes are missing.
class ByteReader {
 public:
  explicit ByteReader(std::string_view bytes) : bytes_(bytes) {}

  template <std::unsigned_integral Value>
  Value read() {
    const std::string_view bytes = take(sizeof(Value));
    Value value = 0;
    for (std::size_t i = 0; i < sizeof value; ++i)
      value = static_cast<Value>(
          value | static_cast<Value>(static_cast<Value>(static_cast<std::uint8_t>(bytes[i])) << (8 * i)));
    return value;
  }
  template <std::same_as<float> Value>
  float read() {
    return std::bit_cast<float>(read<std::uint32_t>());
  }
  template <std::same_as<double> Value>
  double read() {
    return std::bit_cast<double>(read<std::uint64_t>());
  }
  // The next `count` bytes.
  std::string_view take(std::uint64_t count);
  // Throws unless at least `count` items of that many bytes are left, before a caller allocates them.
  void expect(std::uint64_t count, std::size_t bytes_each) const;
  // Throws unless all bytes were read.
  void end() const;

 private:
  std::string_view bytes_;
};

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
  std::uint64_t value() const;

 private:
  void add_byte(std::uint8_t byte) { hash_ = (hash_ ^ byte) * 1099511628211u; }

  std::uint64_t hash_ = 14695981039346656037u;
};

}  // namespace mercury
