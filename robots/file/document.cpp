// SPDX-License-Identifier: Apache-2.0
#include "robots/file/document.h"

#include <array>
#include <bit>
#include <charconv>
#include <cmath>

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

std::string_view name_of(const Event& event) {
  constexpr std::array<std::string_view, 10> names{"null", "",         "a number", "a text",   "a byte string",
                                                   "",     "an array", "",         "an object"};
  if (event.kind == Event::Kind::boolean) return event.truth ? "true" : "false";
  return names[static_cast<std::size_t>(event.kind)];
}

namespace {

constexpr std::size_t line_width = 100;

}  // namespace

// What stands before a key or a value.
void JsonWriter::separate(bool is_key) {
  if (after_key_) return;
  if (!first_) out_ += ',';
  first_ = false;
  if (layout_ == Layout::compact) return;
  // Depth 2 holds the rows of a list.
  if (is_key ? depth_ != 1 : depth_ != 2 || out_.size() - line_ <= line_width) return;
  out_ += '\n';
  line_ = out_.size();
}

void JsonWriter::on(const Event& event) {
  if (event.ends()) {
    first_ = false;
    if (--depth_ == 0 && layout_ == Layout::rows) out_ += '\n';
    out_ += event.kind == Kind::end_array ? ']' : '}';
    return;
  }
  if (event.kind == Kind::bytes) throw InputError("JSON cannot hold a byte string");
  if (event.kind == Kind::number && !std::isfinite(event.number->real)) throw InputError("a number is not finite");
  separate(event.kind == Kind::key);
  if (event.kind == Kind::null) out_ += "null";
  if (event.kind == Kind::boolean) out_ += event.truth ? "true" : "false";
  if (event.kind == Kind::number) out_ += to_text(*event.number);
  if (event.kind == Kind::text || event.kind == Kind::key) out_ += json_text(event.text);
  if (event.kind == Kind::key) out_ += ':';
  after_key_ = event.kind == Kind::key;
  if (!event.begins()) return;
  out_ += event.kind == Kind::begin_array ? '[' : '{';
  ++depth_;
  first_ = true;
}

void CborWriter::big_endian(std::uint64_t value, int bytes) {
  for (int i = bytes - 1; i >= 0; --i) out_ += static_cast<char>(value >> (8 * i) & 0xff);
}

void CborWriter::head(unsigned major_type, std::uint64_t value) {
  const unsigned low = value < 24            ? static_cast<unsigned>(value)
                       : value <= 0xff       ? 24
                       : value <= 0xffff     ? 25
                       : value <= 0xffffffff ? 26
                                             : 27;
  out_ += static_cast<char>(major_type << 5 | low);
  if (low >= 24) big_endian(value, 1 << (low - 24));
}

void CborWriter::number_of(const Number& value) {
  if (value.kind == Number::Kind::natural) return head(0, value.natural);
  if (value.kind == Number::Kind::negative) return head(1, static_cast<std::uint64_t>(-1 - value.negative));
  // The cast of a double too large for a float would be undefined.
  const auto narrow = static_cast<float>(std::abs(value.real) <= 3e38 ? value.real : 0.0);
  if (std::bit_cast<std::uint64_t>(static_cast<double>(narrow)) == std::bit_cast<std::uint64_t>(value.real)) {
    out_ += '\xfa';
    big_endian(std::bit_cast<std::uint32_t>(narrow), 4);
  } else {
    out_ += '\xfb';
    big_endian(std::bit_cast<std::uint64_t>(value.real), 8);
  }
}

void CborWriter::on(const Event& event) {
  if (event.kind == Kind::null) out_ += '\xf6';
  if (event.kind == Kind::boolean) out_ += event.truth ? '\xf5' : '\xf4';
  if (event.kind == Kind::number) number_of(*event.number);
  if (event.kind == Kind::text || event.kind == Kind::key) {
    json_text(event.text);  // throws where it is not UTF-8
    head(3, event.text.size());
    out_ += event.text;
  }
  if (event.kind == Kind::bytes) {
    head(2, event.text.size());
    out_ += event.text;
  }
  if (event.begins()) {
    const unsigned major_type = event.kind == Kind::begin_array ? 4 : 5;
    const bool open_ended = event.announced == unknown_length;
    open_ended_ = open_ended_ << 1 | (open_ended ? 1u : 0u);
    open_ended ? void(out_ += static_cast<char>(major_type << 5 | 31)) : head(major_type, event.announced);
  }
  if (event.ends()) {
    if ((open_ended_ & 1) != 0) out_ += '\xff';
    open_ended_ >>= 1;
  }
}

}  // namespace mercury
