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
  text.erase(0, text.find_first_not_of(".-"));
  if (text.size() > longest) {
    std::size_t end = longest;
    while (end > 0 && is_inside_letter(text[end])) --end;
    text.resize(end);
  }
  return text.empty() ? "robot" : text;
}

std::string FileNames::of(std::string_view name) {
  const std::string wanted = file_name_of(name);
  if (taken_.insert(wanted).second) return wanted;
  std::size_t& number = last_.try_emplace(wanted, 1).first->second;
  std::string own;
  do own = wanted + "-" + std::to_string(++number);
  while (!taken_.insert(own).second);
  return own;
}

std::string shell_quoted(const std::string& word) {
  constexpr std::string_view plain = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_-+=:,./@%";
  if (!word.empty() && word.find_first_not_of(plain) == std::string::npos) return word;
  std::string quoted = "'";
  for (const char letter : word) {
    if (letter == '\'')
      quoted += "'\\''";
    else
      quoted += letter;
  }
  return quoted + "'";
}

}  // namespace mercury
