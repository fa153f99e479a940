// SPDX-License-Identifier: Apache-2.0
#include "app/commands/command_list.h"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include <algorithm>
#include <charconv>
#include <cstdlib>
#include <cstring>

#include "app/commands/program.h"
#include "mercury/generator.h"

namespace mercury {
namespace {

constexpr std::size_t first_column = 28;  // names of options; their explanations begin after it

// Lines of text after names, as in "  --dt S        Time step".
std::string entry(const std::string& name, const std::string& text, std::size_t columns) {
  std::string result = "  " + name;
  const std::vector<std::string> lines = wrapped(text, columns - first_column);
  if (lines.empty()) return result + "\n";
  const bool is_long = result.size() + 2 > first_column;
  if (is_long) result += "\n";
  for (std::size_t i = 0; i < lines.size(); ++i)
    result += std::string(i == 0 && !is_long ? first_column - result.size() : first_column, ' ') + lines[i] + "\n";
  return result;
}

std::string entry(const OptionDescription& option, std::size_t columns) {
  std::string name = fmt::format("{}", fmt::join(option.names, ", "));
  if (!option.form.empty() && !option.positional) name += " " + option.form;
  if (option.many) name += " ...";
  return entry(name, option.help + (option.required ? " (required)" : ""), columns);
}

std::string usage_of(const std::string& name, const std::vector<OptionDescription>& options, bool family) {
  std::string text = "Usage: " + name;
  if (family) return text + " COMMAND [OPTIONS]";
  for (const OptionDescription& option : options) {
    if (!option.positional) continue;
    const std::string argument = option.names.front() + (option.many ? "..." : "");
    text += option.required ? " " + argument : " [" + argument + "]";
  }
  for (const OptionDescription& option : options)
    if (option.required && !option.positional) text += fmt::format(" {} {}", option.names.front(), option.form);
  return text + " [OPTIONS]";
}

// A prose paragraph is wrapped; indented lines, which are examples, stay as they are. An explanation after an example
// that is too wide moves to a line of its own.
std::string footer_page(const std::string& footer, std::size_t columns) {
  std::string page, paragraph;
  const auto end_paragraph = [&] {
    for (const std::string& line : wrapped(paragraph, columns)) page += line + "\n";
    paragraph.clear();
  };
  for (std::size_t start = 0; start < footer.size();) {
    const std::size_t end = std::min(footer.find('\n', start), footer.size());
    const std::string line = footer.substr(start, end - start);
    start = end + 1;
    if (!line.empty() && line.front() != ' ') {
      paragraph += (paragraph.empty() ? "" : " ") + line;
      if (line.ends_with(":")) end_paragraph();
      continue;
    }
    end_paragraph();
    const std::size_t gap = line.size() > columns ? line.find("   ", 2) : std::string::npos;
    if (gap == std::string::npos) {
      page += line + "\n";
    } else {
      page += line.substr(0, gap) + "\n";
      for (const std::string& part : wrapped(line.substr(gap), columns - 6)) page += "      " + part + "\n";
    }
  }
  end_paragraph();
  return page;
}

bool is_kind(const std::string& group) {
  return std::ranges::any_of(generators(), [&](const Generator& generator) { return generator.title == group; });
}

}  // namespace

std::vector<std::string> groups_of(const std::vector<OptionDescription>& options) {
  std::vector<std::string> groups;
  for (const OptionDescription& option : options)
    if (!option.positional && std::ranges::find(groups, option.group) == groups.end()) groups.push_back(option.group);
  const bool of_one_kind = std::ranges::count_if(groups, is_kind) == 1;
  const auto rank = [&](const std::string& group) {
    if (group == "Options" || group == "General") return group == "Options" ? 0 : 4;
    return !is_kind(group) ? 2 : of_one_kind ? 1 : 3;
  };
  std::ranges::stable_sort(groups, {}, rank);
  return groups;
}

std::vector<std::string> wrapped(const std::string& text, std::size_t columns) {
  std::vector<std::string> lines;
  for (std::size_t start = 0; start < text.size();) {
    std::size_t end = std::min(text.find(' ', start), text.size());
    // Long lists break after a comma.
    const std::size_t comma = end - start > columns ? text.rfind(',', start + columns - 1) : std::string::npos;
    if (comma != std::string::npos && comma > start) end = comma + 1;
    const std::string word = text.substr(start, end - start);
    start = end < text.size() && text[end] != ' ' ? end : end + 1;
    if (word.empty()) continue;
    if (lines.empty() || lines.back().size() + 1 + word.size() > columns)
      lines.push_back(word);
    else
      lines.back() += " " + word;
  }
  return lines;
}

std::string help_page(const Command& command, bool brief, int columns) {
  const auto width = static_cast<std::size_t>(columns);
  const std::string name = command.full_name();
  const std::vector<OptionDescription> options = options_of(command);
  const std::vector<std::string> commands = names_of_commands(command);
  std::string page = fmt::format("{}.\n\n{}\n", fmt::join(wrapped(command.help(), width), "\n"),
                                 fmt::join(wrapped(usage_of(name, options, !commands.empty()), width), "\n         "));
  while (page.find("..\n") != std::string::npos) page.replace(page.find("..\n"), 3, ".\n");
  if (options.front().positional) page += "\n";
  for (const OptionDescription& option : options)
    if (option.positional) page += entry(option, width);
  if (!commands.empty()) page += "\nCommands:\n";
  for (const std::string& child : commands) page += entry(child, command.find_command(child)->help(), width);
  if (brief) {
    std::string most_used;
    for (const OptionDescription& option : options)
      if (!option.positional && option.first_screen) most_used += entry(option, width);
    if (!most_used.empty()) page += "\nMost used options:\n" + most_used;
    return page + fmt::format("\n{} --help shows all\n", name);
  }
  for (const std::string& group : groups_of(options)) {
    page += "\n" + group + ":\n";
    for (const OptionDescription& option : options)
      if (!option.positional && option.group == group) page += entry(option, width);
  }
  if (const std::string footer = command.footer(); !footer.empty()) page += "\n" + footer_page(footer, width);
  return page;
}

int columns_of_standard_output() {
  int columns = 80;
  winsize size{};
  const char* variable = std::getenv("COLUMNS");
  if (ioctl(STDOUT_FILENO, TIOCGWINSZ, &size) == 0 && size.ws_col > 0)
    columns = size.ws_col;
  else if (variable)
    std::from_chars(variable, variable + std::strlen(variable), columns);
  return std::clamp(columns, 40, 100);
}

}  // namespace mercury
