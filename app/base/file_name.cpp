// SPDX-License-Identifier: Apache-2.0
#include "app/base/file_name.h"

namespace mercury {
namespace {

constexpr std::size_t longest = 120;  // leaves room for numbers and extensions, names of files end at 255 bytes

bool is_inside_letter(char byte) { return (static_cast<unsigned char>(byte) & 0xc0) == 0x80; }  // of UTF-8

}  // namespace

std::string file_name_of(std::string_view name) {
  std::string text;
  for (const char letter : name) {
    const auto code = static_cast<unsigned char>(letter);
    text += code < 0x20 || code == 0x7f || std::string_view("/\\:*?\"<>|").find(letter) != std::string_view::npos
                ? '_'
                : letter;
  }
  // A leading dot would hide the file, a leading dash look like an option.
  while (!text.empty() && (text.front() == '.' || text.front() == '-')) text.erase(0, 1);
  if (text.size() > longest) {
    std::size_t end = longest;
    while (end > 0 && is_inside_letter(text[end])) --end;
    text.resize(end);
  }
  return text.empty() ? "robot" : text;
}

}  // namespace mercury
