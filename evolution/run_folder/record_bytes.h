// SPDX-License-Identifier: Apache-2.0
// Numbers and text as little-endian bytes, and back.
#pragma once

#include <bit>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <stdexcept>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

namespace mercury {

// Bytes that are not what they should be. what() says why; who knows the file adds the place.
class DamagedBytes : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

class RecordWriter {
 public:
  template <std::unsigned_integral Number>
  void number(Number value) {
    for (std::size_t i = 0; i < sizeof value; ++i) bytes_.push_back(static_cast<char>(value >> (8 * i)));
  }
  void number(double value) { number(std::bit_cast<std::uint64_t>(value)); }
  void count(std::size_t value) { number(static_cast<std::uint32_t>(value)); }
  void text(std::string_view text) {
    count(text.size());
    bytes_.append(text);
  }
  template <class Number>
  void numbers(const std::vector<Number>& values) {
    count(values.size());
    for (const Number value : values) number(value);
  }

  const std::string& bytes() const { return bytes_; }

 private:
  std::string bytes_;
};

// All functions throw DamagedBytes where the bytes end too early. Nothing is allocated from counts that the bytes that
// follow do not back.
class RecordReader {
 public:
  explicit RecordReader(std::string_view bytes) : rest_(bytes) {}

  template <class Number>
  Number number() {
    if constexpr (std::is_same_v<Number, double>) {
      return std::bit_cast<double>(number<std::uint64_t>());
    } else {
      Number value = 0;
      const std::string_view bytes = take(sizeof value);
      for (std::size_t i = 0; i < sizeof value; ++i)
        value = static_cast<Number>(value | static_cast<Number>(static_cast<std::uint8_t>(bytes[i])) << (8 * i));
      return value;
    }
  }
  // A number of things of at least `size` bytes each.
  std::size_t count(std::size_t size) {
    const std::size_t value = number<std::uint32_t>();
    if (value > rest_.size() / size) throw DamagedBytes("a count is larger than the record");
    return value;
  }
  std::string_view text() { return take(count(1)); }
  template <class Number>
  std::vector<Number> numbers() {
    std::vector<Number> values(count(sizeof(Number)));
    for (Number& value : values) value = number<Number>();
    return values;
  }
  std::string_view take(std::size_t size) {
    if (size > rest_.size()) throw DamagedBytes("a record ends too early");
    const std::string_view taken = rest_.substr(0, size);
    rest_.remove_prefix(size);
    return taken;
  }
  bool is_at_end() const { return rest_.empty(); }

 private:
  std::string_view rest_;
};

}  // namespace mercury
