// SPDX-License-Identifier: Apache-2.0
// Numbers and text as bytes, and back: little-endian on every machine, and safe to read from a damaged file.
#pragma once

#include <bit>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <span>
#include <stdexcept>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "mercury/fnv.h"

namespace mercury {

// Bytes that are not what they should be. what() says why; the caller, who knows where they come from, adds the place.
class DamagedBytes : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

class ByteWriter {
 public:
  // A whole number in as many bytes as it has, or the bits of a float or double.
  template <std::unsigned_integral Value>
  void add(Value value) {
    for (std::size_t i = 0; i < sizeof value; ++i) bytes_.push_back(static_cast<char>(value >> (8 * i) & 0xff));
  }
  void add(float value) { add(std::bit_cast<std::uint32_t>(value)); }
  void add(double value) { add(std::bit_cast<std::uint64_t>(value)); }
  void add(std::span<const float> values) {
    if constexpr (std::endian::native == std::endian::little)
      append(std::string_view(reinterpret_cast<const char*>(values.data()), values.size_bytes()));
    else
      for (const float value : values) add(value);
  }
  void append(std::string_view bytes) { bytes_.append(bytes); }
  void append(std::span<const std::uint8_t> bytes) {
    bytes_.append(reinterpret_cast<const char*>(bytes.data()), bytes.size());
  }
  void count(std::size_t value) { add(static_cast<std::uint32_t>(value)); }
  void text(std::string_view text) {
    count(text.size());
    append(text);
  }
  template <class Number>
  void numbers(const std::vector<Number>& values) {
    count(values.size());
    for (const Number value : values) add(value);
  }

  const std::string& bytes() const { return bytes_; }
  std::string take() && { return std::move(bytes_); }

 private:
  std::string bytes_;
};

// All functions throw DamagedBytes where bytes are missing. Nothing is allocated from counts that the bytes that follow
// do not back.
class ByteReader {
 public:
  explicit ByteReader(std::string_view bytes) : rest_(bytes) {}

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
  // A number of items of at least `bytes_each` bytes.
  std::size_t count(std::size_t bytes_each) {
    const std::size_t value = read<std::uint32_t>();
    expect(value, bytes_each);
    return value;
  }
  std::string_view text() { return take(count(1)); }
  template <class Number>
  std::vector<Number> numbers() {
    std::vector<Number> values(count(sizeof(Number)));
    for (Number& value : values) value = read<Number>();
    return values;
  }
  // The next `count` bytes.
  std::string_view take(std::uint64_t count) {
    expect(count, 1);
    const std::string_view taken = rest_.substr(0, static_cast<std::size_t>(count));
    rest_.remove_prefix(taken.size());
    return taken;
  }
  // Throws unless at least `count` items of `bytes_each` bytes are left, before a caller allocates them.
  void expect(std::uint64_t count, std::size_t bytes_each) const {
    if (count > rest_.size() / bytes_each) throw DamagedBytes("bytes are missing");
  }
  bool is_at_end() const { return rest_.empty(); }
  // Throws unless all bytes were read.
  void end() const {
    if (!rest_.empty()) throw DamagedBytes(std::to_string(rest_.size()) + " bytes follow its end");
  }

 private:
  std::string_view rest_;
};

// A checksum of bytes that follow others.
constexpr std::uint64_t checksum_of(std::string_view bytes, std::uint64_t so_far = Fnv1a::empty) {
  return Fnv1a(so_far).add(bytes).value();
}
constexpr std::uint32_t short_checksum_of(std::string_view bytes) {
  const std::uint64_t checksum = checksum_of(bytes);
  return static_cast<std::uint32_t>(checksum ^ checksum >> 32);
}

}  // namespace mercury
