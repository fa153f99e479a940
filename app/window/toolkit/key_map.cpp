// SPDX-License-Identifier: Apache-2.0
#include "app/window/toolkit/key_map.h"

#include <fmt/format.h>

#include <algorithm>
#include <fstream>
#include <iterator>

#include "mercury/names.h"

namespace mercury::window {
namespace {

constexpr std::size_t most_bytes = 64 * 1024;

std::string_view trimmed(std::string_view text) {
  const auto blank = [](char c) { return c == ' ' || c == '\t' || c == '\r'; };
  while (!text.empty() && blank(text.front())) text.remove_prefix(1);
  while (!text.empty() && blank(text.back())) text.remove_suffix(1);
  return text;
}

// Calls `act` with each part of a text, without the separators.
void for_each_part(std::string_view text, std::string_view separator, auto act) {
  for (;;) {
    const std::size_t end = text.find(separator);
    act(text.substr(0, end));
    if (end == std::string_view::npos) return;
    text.remove_prefix(end + separator.size());
  }
}

// What a message quotes of a file: its start, without characters that a terminal would act on.
std::string quoted(std::string_view text) {
  std::string shown;
  for (const char c : text.substr(0, 40)) shown += c >= ' ' && c < 0x7f ? c : '?';
  return fmt::format("\"{}\"{}", shown, text.size() > 40 ? "..." : "");
}

}  // namespace

KeyMap::KeyMap() : keys_(key_bindings().size()) {
  for (std::size_t i = 0; i < keys_.size(); ++i) {
    for_each_part(key_bindings()[i].keys, " or ", [&](std::string_view part) {
      if (const auto chord = key_chord(part)) keys_[i].chords.push_back(*chord);
    });
  }
}

std::string KeyMap::read(std::string_view text) {
  std::string problem;
  int number = 0, more = 0;
  for_each_part(text, "\n", [&](std::string_view line) {
    ++number;
    const std::string wrong = read_line(line);
    if (wrong.empty()) return;
    if (problem.empty())
      problem = fmt::format("{}: {}", number, wrong);
    else
      ++more;
  });
  if (more > 0) problem += fmt::format(" ({} more {} cannot be used)", more, more == 1 ? "line" : "lines");
  return problem;
}

// Returns what is wrong with the line; empty = nothing.
std::string KeyMap::read_line(std::string_view line) {
  line = trimmed(line);
  if (line.empty() || line.front() == '#') return {};
  const std::size_t equals = line.find('=');
  if (equals == std::string_view::npos) return fmt::format("{} is no line COMMAND = KEY", quoted(line));
  const std::string_view name = trimmed(line.substr(0, equals)), value = trimmed(line.substr(equals + 1));
  const auto bindings = key_bindings();
  const auto binding = std::ranges::find(bindings, name, &KeyBinding::name);
  if (binding == bindings.end()) {
    std::vector<std::string> names;
    for (const KeyBinding& one : bindings) names.emplace_back(one.name);
    return fmt::format("{} is no command{}", quoted(name), suggestion(std::string(name), names));
  }
  std::vector<KeyChord> chords;
  std::string wrong;
  if (!value.empty())
    for_each_part(value, ",", [&](std::string_view part) {
      const auto chord = key_chord(trimmed(part));
      if (!chord && wrong.empty())
        wrong =
            fmt::format("{} is no key for a command; write M, Ctrl Shift M, F5, Right or Comma", quoted(trimmed(part)));
      if (chord && std::ranges::find(chords, *chord) == chords.end()) chords.push_back(*chord);
    });
  if (!wrong.empty()) return wrong;
  const auto index = static_cast<std::size_t>(binding - bindings.begin());
  for (std::size_t i = 0; i < keys_.size(); ++i)
    for (const KeyChord& chord : chords)
      if (i != index && keys_[i].by_user && std::ranges::find(keys_[i].chords, chord) != keys_[i].chords.end())
        return fmt::format("{} is the key of {} already", text_of(chord), bindings[i].name);
  for (Keys& keys : keys_)
    std::erase_if(keys.chords, [&](const KeyChord& chord) { return std::ranges::find(chords, chord) != chords.end(); });
  keys_[index] = {std::move(chords), true};
  return {};
}

std::optional<Action> KeyMap::command_of(const KeyPress& press) const {
  // "Shift Right" comes before "Right", which matches with Shift as well.
  for (const bool shift : {true, false})
    for (std::size_t i = 0; i < keys_.size(); ++i)
      for (const KeyChord& chord : keys_[i].chords) {
        if (chord.shift != shift || !chord.matches(press)) continue;
        if (press.repeated && !key_bindings()[i].repeats) return std::nullopt;
        return key_bindings()[i].action;
      }
  return std::nullopt;
}

std::string KeyMap::keys_of(Action action) const {
  std::string text;
  for (std::size_t i = 0; i < keys_.size(); ++i) {
    if (key_bindings()[i].action != action) continue;
    for (const KeyChord& chord : keys_[i].chords) text += (text.empty() ? "" : " or ") + text_of(chord);
  }
  return text;
}

std::string KeyMap::text() const {
  std::string text;
  for (std::size_t i = 0; i < keys_.size(); ++i) {
    std::string line;
    for (const KeyChord& chord : keys_[i].chords) line += (line.empty() ? "" : ", ") + text_of(chord);
    text += fmt::format("{} = {}\n", key_bindings()[i].name, line);
  }
  return text;
}

std::string load_keys(KeyMap& keys, const std::filesystem::path& file) {
  std::error_code unknown;
  if (!std::filesystem::exists(file, unknown)) return {};
  std::ifstream stream(file, std::ios::binary);
  std::string text(most_bytes + 1, '\0');
  stream.read(text.data(), static_cast<std::streamsize>(text.size()));
  if (stream.bad() || (stream.gcount() == 0 && !stream.eof()))
    return fmt::format("{}: cannot be read; all keys are the default ones", file.string());
  text.resize(static_cast<std::size_t>(stream.gcount()));
  if (text.size() > most_bytes)
    return fmt::format("{}: is longer than 64 KiB; all keys are the default ones", file.string());
  const std::string problem = keys.read(text);
  return problem.empty() ? problem : fmt::format("{}:{}", file.string(), problem);
}

bool write_keys_template(const std::filesystem::path& file) {
  std::error_code failed;
  if (std::filesystem::exists(file, failed)) return true;
  std::filesystem::create_directories(file.parent_path(), failed);
  std::ofstream stream(file);
  stream << "# Keys of Mercury's window, read when it opens. Remove the # of a line and change its keys:\n"
            "# M, Ctrl Shift M, F5, Right, Comma; several with commas between them; nothing for no key.\n";
  std::string line;
  for_each_part(KeyMap().text(), "\n", [&](std::string_view part) {
    if (!part.empty()) stream << "# " << part << '\n';
  });
  return static_cast<bool>(stream.flush());
}

std::string with_keys(const KeyMap& keys, const std::string& text, Action action) {
  const std::string names = keys.keys_of(action);
  if (names.empty()) return text;
  return fmt::format("{} ({}{})", text, names.size() == 1 ? "key " : "", names);
}

}  // namespace mercury::window
