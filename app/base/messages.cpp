// SPDX-License-Identifier: Apache-2.0
#include "app/base/messages.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <cerrno>
#include <cstdint>

#include "app/base/standard_streams.h"

namespace mercury {
namespace {

std::atomic<Verbosity> chosen = Verbosity::normal;

void write_line(std::string_view text) { write_to_standard_error(fmt::format("mercury: {}\n", printable(text))); }

// The code point of a well-formed character.
std::uint32_t code_of(std::string_view character) {
  const auto first = static_cast<unsigned char>(character[0]);
  if (character.size() == 1) return first;
  std::uint32_t code = first & (0x7fu >> character.size());
  for (const char byte : character.substr(1)) code = code << 6 | (static_cast<unsigned char>(byte) & 0x3f);
  return code;
}

// Characters that move the cursor, change the terminal, or turn the direction of the text that follows.
bool is_obeyed(std::uint32_t code) {
  return code < 0x20 || (code >= 0x7f && code < 0xa0) || code == 0x200e || code == 0x200f || code == 0x061c ||
         (code >= 0x2028 && code <= 0x202e) || (code >= 0x2066 && code <= 0x2069);
}

std::string escaped(std::uint32_t code) {
  if (code == '\n') return "\\n";
  if (code == '\r') return "\\r";
  if (code == '\t') return "\\t";
  return code < 0x100 ? fmt::format("\\x{:02x}", code) : fmt::format("\\u{:04x}", code);
}

std::string escaped(std::string_view text) {
  std::string result;
  result.reserve(text.size());
  while (!text.empty()) {
    const std::size_t length = utf8_length(text);
    if (length == 0) {
      result += escaped(static_cast<unsigned char>(text[0]));
    } else if (const std::uint32_t code = code_of(text.substr(0, length)); is_obeyed(code)) {
      result += escaped(code);
    } else {
      result += text.substr(0, length);
    }
    text.remove_prefix(std::max<std::size_t>(1, length));
  }
  return result;
}

bool is_inside_character(const std::string& text, std::size_t place) {
  return (static_cast<unsigned char>(text[place]) & 0xc0) == 0x80;
}

}  // namespace

void set_verbosity(Verbosity verbosity) { chosen = verbosity; }
Verbosity verbosity() { return chosen; }

void warn(std::string_view text) { write_line(text); }

void say(std::string_view text) {
  if (verbosity() != Verbosity::quiet) write_line(text);
}

void say_detail(std::string_view text) {
  if (verbosity() == Verbosity::verbose) write_line(text);
}

void write_to_standard_error(std::string_view text) {
  const NoBrokenPipeSignal reader_may_be_gone;
  while (!text.empty()) {
    const ssize_t written = ::write(STDERR_FILENO, text.data(), text.size());
    if (written < 0 && errno == EINTR) continue;
    if (written <= 0) return;
    text.remove_prefix(static_cast<std::size_t>(written));
  }
}

std::string printable(std::string_view text, std::size_t longest) {
  constexpr std::string_view gap = " ... ";
  // An escaped text is not shorter than the text, so its middle is not needed.
  const bool is_long = text.size() > longest;
  const std::string whole =
      is_long ? escaped(text.substr(0, longest)) + escaped(text.substr(text.size() - longest)) : escaped(text);
  if (!is_long && whole.size() <= longest) return whole;
  const std::size_t kept = longest > gap.size() ? (longest - gap.size()) / 2 : 0;
  std::size_t head = kept, tail = whole.size() - kept;
  while (head > 0 && is_inside_character(whole, head)) --head;
  while (tail < whole.size() && is_inside_character(whole, tail)) ++tail;
  return whole.substr(0, head) + std::string(gap) + whole.substr(tail);
}

std::size_t utf8_length(std::string_view text) {
  if (text.empty()) return 0;
  const auto byte = [&](std::size_t i) { return static_cast<unsigned char>(text[i]); };
  const unsigned first = byte(0);
  const std::size_t length = first < 0x80                    ? 1
                             : first >= 0xc2 && first < 0xe0 ? 2
                             : first >= 0xe0 && first < 0xf0 ? 3
                             : first >= 0xf0 && first < 0xf5 ? 4
                                                             : 0;
  if (length == 0 || length > text.size()) return 0;
  for (std::size_t i = 1; i < length; ++i)
    if ((byte(i) & 0xc0) != 0x80) return 0;
  const bool overlong = (first == 0xe0 && byte(1) < 0xa0) || (first == 0xf0 && byte(1) < 0x90);
  const bool beyond = (first == 0xed && byte(1) >= 0xa0) || (first == 0xf4 && byte(1) >= 0x90);
  return overlong || beyond ? 0 : length;
}

}  // namespace mercury
