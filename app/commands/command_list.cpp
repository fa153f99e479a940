// SPDX-License-Identifier: Apache-2.0
#include "app/commands/command_list.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cctype>
#include <nlohmann/json.hpp>

#include "app/base/version.h"
#include "app/options/option_values.h"

namespace mercury {
namespace {

bool is_word(std::string_view text) {
  const auto of_word = [](unsigned char letter) {
    return std::islower(letter) || std::isdigit(letter) || letter == '-' || letter == '_';
  };
  return !text.empty() && std::ranges::all_of(text, of_word) && std::isalnum(static_cast<unsigned char>(text.front()));
}

// The words that a form names, as in "auto|cpu|cuda[:N]", and whether it allows nothing else.
std::pair<std::vector<std::string>, bool> words_of(const std::string& form) {
  std::vector<std::string> words;
  bool closed = true;
  const std::vector<std::string_view> parts = split(form, '|');
  for (const std::string_view part : parts) {
    const std::string_view word = part.substr(0, part.find('['));
    if (is_word(word)) words.emplace_back(word);
    closed = closed && is_word(part);
  }
  return {words, closed && parts.size() > 1};
}

// ".json" and ".cbor" of "FILE.json" and "Robot files (.json, .cbor)".
std::vector<std::string> extensions_in(const std::string& text) {
  std::vector<std::string> extensions;
  for (std::size_t dot = text.find('.'); dot != std::string::npos; dot = text.find('.', dot + 1)) {
    std::size_t end = dot + 1;
    while (end < text.size() && std::isalnum(static_cast<unsigned char>(text[end]))) ++end;
    const bool begins = dot == 0 || std::string_view(" (,E").find(text[dot - 1]) != std::string_view::npos;
    const std::string extension = text.substr(dot, end - dot);
    if (begins && end > dot + 1 && std::ranges::find(extensions, extension) == extensions.end())
      extensions.push_back(extension);
  }
  return extensions;
}

std::string kind_from_form(const std::string& form) {
  bool file = false, folder = false;
  for (const std::string_view part : split(form, '|')) {
    file = file || part.starts_with("FILE") || part.starts_with("PATH");
    folder = folder || part.starts_with("FOLDER") || part.starts_with("PATH");
  }
  if (file || folder) return file && folder ? "path" : file ? "file" : "folder";
  return form == "PROGRAM" ? "program" : "text";
}

void add_commands(const Command& command, std::vector<std::string> words, std::vector<CommandDescription>& list) {
  const std::vector<Command> children = command.commands();
  list.push_back({.words = words,
                  .help = command.help(),
                  .footer = command.footer(),
                  .options = options_of(command),
                  .family = !children.empty()});
  for (const Command& child : children) {
    std::vector<std::string> below = words;
    below.push_back(child.name());
    add_commands(child, std::move(below), list);
  }
}

}  // namespace

OptionDescription description_of(const Option& option) {
  OptionDescription found;
  found.positional = option.is_positional();
  if (found.positional) {
    found.names = {option.name()};
  } else {
    found.names = option.short_names();
    for (const std::string& name : option.long_names()) found.names.push_back(name);
  }
  found.help = option.help();
  found.group = option.group();
  found.required = option.is_required();
  found.first_screen = option.is_on_first_screen() || found.required;
  if (!option.takes_value()) {
    found.kind = "switch";
    return found;
  }
  found.form = option.form();
  found.repeatable = !option.takes_last();
  found.many = option.takes_several();
  const auto [words, closed] = words_of(found.form);
  const std::vector<std::string> offered = option.offered();
  found.choices = offered.empty() ? words : offered;
  found.kind = option.number_kind();
  if (found.kind.empty()) found.kind = closed ? "choice" : kind_from_form(found.form);
  if (found.kind == "file" || found.kind == "path") {
    found.extensions = extensions_in(found.form);
    if (found.extensions.empty()) found.extensions = extensions_in(found.help);
  }
  return found;
}

std::string CommandDescription::name() const {
  return words.empty() ? "mercury" : fmt::format("mercury {}", fmt::join(words, " "));
}

std::vector<OptionDescription> options_of(const Command& command) {
  std::vector<OptionDescription> options;
  for (const Option& option : command.options())
    if (!option.group().empty()) options.push_back(description_of(option));
  std::stable_partition(options.begin(), options.end(),
                        [](const OptionDescription& option) { return option.positional; });
  return options;
}

std::vector<CommandDescription> command_list(const Command& program) {
  std::vector<CommandDescription> list;
  add_commands(program, {}, list);
  return list;
}

std::string json_of(const std::vector<CommandDescription>& commands) {
  nlohmann::ordered_json list = nlohmann::ordered_json::array();
  for (const CommandDescription& command : commands) {
    nlohmann::ordered_json options = nlohmann::ordered_json::array();
    for (const OptionDescription& option : command.options)
      options.push_back({{"names", option.names},
                         {"kind", option.kind},
                         {"form", option.form},
                         {"choices", option.choices},
                         {"extensions", option.extensions},
                         {"help", option.help},
                         {"group", option.group},
                         {"positional", option.positional},
                         {"required", option.required},
                         {"repeatable", option.repeatable},
                         {"many", option.many}});
    list.push_back(
        {{"words", command.words}, {"family", command.family}, {"help", command.help}, {"options", options}});
  }
  const nlohmann::ordered_json document{
      {"format", "mercury-options"}, {"version", 1}, {"program", program_version}, {"commands", list}};
  return document.dump(1) + "\n";
}

}  // namespace mercury
