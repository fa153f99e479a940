// SPDX-License-Identifier: Apache-2.0
#include "robots/file/document.h"

#include <array>
#include <bit>
#include <charconv>
#include <cmath>

#include "mercury/error.h"

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

namespace {

constexpr std::size_t line_width = 100;

}  // namespace

void JsonWriter::before_value() {
  if (after_key_) {
    after_key_ = false;
    return;
  }
  if (!first_) out_ += ',';
  first_ = false;
  // Depth 2 holds the rows of a list.
  if (layout_ == Layout::rows && depth_ == 2 && out_.size() - line_ > line_width) {
    out_ += '\n';
    line_ = out_.size();
  }
}

void JsonWriter::null() {
  before_value();
  out_ += "null";
}

void JsonWriter::boolean(bool value) {
  before_value();
  out_ += value ? "true" : "false";
}

void JsonWriter::number(const Number& value) {
  if (!std::isfinite(value.real)) throw InputError("a number is not finite");
  before_value();
  out_ += to_text(value);
}

void JsonWriter::text(std::string_view value) {
  before_value();
  out_ += json_text(value);
}

void JsonWriter::bytes(std::string_view) { throw InputError("JSON cannot hold a byte string"); }

void JsonWriter::begin(char bracket) {
  before_value();
  out_ += bracket;
  ++depth_;
  first_ = true;
}

void JsonWriter::end(char bracket) {
  --depth_;
  first_ = false;
  if (layout_ == Layout::rows && depth_ == 0) out_ += '\n';
  out_ += bracket;
}

void JsonWriter::begin_array(std::size_t) { begin('['); }
void JsonWriter::end_array() { end(']'); }
void JsonWriter::begin_object(std::size_t) { begin('{'); }
void JsonWriter::end_object() { end('}'); }

void JsonWriter::key(std::string_view name) {
  if (!first_) out_ += ',';
  first_ = false;
  if (layout_ == Layout::rows && depth_ == 1) {
    out_ += '\n';
    line_ = out_.size();
  }
  out_ += json_text(name);
  out_ += ':';
  after_key_ = true;
}

void CborWriter::head(unsigned major_type, std::uint64_t value) {
  const auto put = [&](unsigned low, int bytes) {
    out_ += static_cast<char>(major_type << 5 | low);
    for (int i = bytes - 1; i >= 0; --i) out_ += static_cast<char>(value >> (8 * i) & 0xff);
  };
  if (value < 24)
    put(static_cast<unsigned>(value), 0);
  else if (value <= 0xff)
    put(24, 1);
  else if (value <= 0xffff)
    put(25, 2);
  else if (value <= 0xffffffff)
    put(26, 4);
  else
    put(27, 8);
}

void CborWriter::null() { out_ += '\xf6'; }
void CborWriter::boolean(bool value) { out_ += value ? '\xf5' : '\xf4'; }

void CborWriter::number(const Number& value) {
  if (value.kind == Number::Kind::natural) return head(0, value.natural);
  if (value.kind == Number::Kind::negative) return head(1, static_cast<std::uint64_t>(-1 - value.negative));
  const auto put = [&](char first, std::uint64_t bits, int bytes) {
    out_ += first;
    for (int i = bytes - 1; i >= 0; --i) out_ += static_cast<char>(bits >> (8 * i) & 0xff);
  };
  // The cast of a double too large for a float would be undefined.
  const auto narrow = static_cast<float>(std::abs(value.real) <= 3e38 ? value.real : 0.0);
  if (std::bit_cast<std::uint64_t>(static_cast<double>(narrow)) == std::bit_cast<std::uint64_t>(value.real))
    put('\xfa', std::bit_cast<std::uint32_t>(narrow), 4);
  else
    put('\xfb', std::bit_cast<std::uint64_t>(value.real), 8);
}

void CborWriter::text(std::string_view value) {
  json_text(value);  // throws where it is not UTF-8
  head(3, value.size());
  out_ += value;
}

void CborWriter::bytes(std::string_view value) {
  head(2, value.size());
  out_ += value;
}

void CborWriter::begin(unsigned major_type, std::size_t announced) {
  open_ended_ = open_ended_ << 1 | (announced == unknown_length ? 1u : 0u);
  if (announced == unknown_length)
    out_ += static_cast<char>(major_type << 5 | 31);
  else
    head(major_type, announced);
}

void CborWriter::end() {
  if ((open_ended_ & 1) != 0) out_ += '\xff';
  open_ended_ >>= 1;
}

void CborWriter::begin_array(std::size_t announced) { begin(4, announced); }
void CborWriter::end_array() { end(); }
void CborWriter::begin_object(std::size_t announced) { begin(5, announced); }
void CborWriter::end_object() { end(); }
void CborWriter::key(std::string_view name) { text(name); }

}  // namespace mercury
