// SPDX-License-Identifier: Apache-2.0
#include "app/commands/command_list.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cctype>

#include "app/base/version.h"

namespace mercury {
namespace {

// Text for troff: no letter of it is a command, and a minus sign stays one, so that examples can be copied.
std::string troff(const std::string& text) {
  std::string result;
  for (const char letter : text) {
    switch (letter) {
      case '\\':
        result += "\\e";
        break;
      case '-':
        result += "\\-";
        break;
      case '\'':
        result += "\\(aq";
        break;
      case '`':
        result += "\\(ga";
        break;
      case '"':
        result += "\\(dq";
        break;
      case '^':
        result += "\\(ha";
        break;
      case '~':
        result += "\\(ti";
        break;
      default:
        result += letter;
    }
  }
  return result.starts_with(".") ? "\\&" + result : result;
}

// In lines that stay below 80 letters when they are escaped.
std::string paragraph(const std::string& text) {
  std::string result;
  for (const std::string& line : wrapped(text, 64)) result += troff(line) + "\n";
  return result;
}

std::string upper_case(std::string text) {
  std::ranges::transform(text, text.begin(), [](unsigned char letter) { return std::toupper(letter); });
  return text;
}

std::string names_of(const OptionDescription& option) {
  std::string text;
  for (const std::string& name : option.names) text += (text.empty() ? "\\fB" : ", \\fB") + troff(name) + "\\fR";
  if (option.positional) text = "\\fI" + troff(option.names.front()) + "\\fR";
  if (!option.form.empty() && !option.positional) text += " \\fI" + troff(option.form) + "\\fR";
  return text + (option.many ? " ..." : "");
}

std::string synopsis_of(const CommandDescription& command) {
  std::string text = ".B " + troff(command.name()) + "\n";
  if (command.family) return text + ".I COMMAND\n[\\fIOPTIONS\\fR]\n";
  for (const OptionDescription& option : command.options)
    if (option.positional) {
      const std::string name = fmt::format("\\fI{}\\fR{}", troff(option.names.front()), option.many ? " ..." : "");
      text += (option.required ? name : "[" + name + "]") + "\n";
    }
  for (const OptionDescription& option : command.options)
    if (option.required && !option.positional)
      text += fmt::format("\\fB{}\\fR \\fI{}\\fR\n", troff(option.names.front()), troff(option.form));
  return text + "[\\fIOPTIONS\\fR]\n";
}

std::string options_section(const CommandDescription& command) {
  std::string text;
  const auto group_of = [](const OptionDescription& option) { return option.positional ? "Arguments" : option.group; };
  std::vector<std::string> groups = groups_of(command.options);
  if (std::ranges::any_of(command.options, &OptionDescription::positional)) groups.insert(groups.begin(), "Arguments");
  for (const std::string& group : groups) {
    text += fmt::format(".SS {}\n", troff(group));
    for (const OptionDescription& option : command.options)
      if (group_of(option) == group)
        text += fmt::format(".TP\n{}\n{}", names_of(option),
                            paragraph(option.help + (option.required ? " (required)" : "")));
  }
  return text.empty() ? "" : ".SH OPTIONS\n" + text;
}

// Prose as it is, indented lines as examples.
std::string footer_section(const std::string& footer) {
  std::string text;
  bool in_example = false;
  for (std::size_t start = 0; start < footer.size();) {
    const std::size_t end = std::min(footer.find('\n', start), footer.size());
    const std::string line = footer.substr(start, end - start);
    start = end + 1;
    const bool example = line.starts_with(" ");
    if (example != in_example) text += example ? ".PP\n.nf\n" : ".fi\n";
    in_example = example;
    if (line.empty()) {
      if (start < footer.size() && !text.ends_with(".fi\n")) text += ".PP\n";
    } else {
      text += example ? troff(line.substr(line.find_first_not_of(' '))) + "\n" : paragraph(line);
    }
  }
  if (in_example) text += ".fi\n";
  std::string once = text;
  for (std::size_t twice; (twice = once.find(".PP\n.PP\n")) != std::string::npos;) once.erase(twice, 4);
  return once.empty() ? "" : ".SH NOTES AND EXAMPLES\n" + once;
}

std::string commands_section(const CommandDescription& command, const std::vector<CommandDescription>& all) {
  std::string text;
  for (const CommandDescription& child : all) {
    if (child.words.size() != command.words.size() + 1 ||
        !std::equal(command.words.begin(), command.words.end(), child.words.begin()))
      continue;
    text += fmt::format(".TP\n\\fB{}\\fR(1)\n{}", troff(man_page_name(child)), paragraph(child.help));
  }
  return text.empty() ? "" : ".SH COMMANDS\n" + text;
}

// What holds for all commands.
constexpr const char* common_sections =
    ".SH EXIT STATUS\n"
    ".TP\n.B 0\nThe work is done.\n"
    ".TP\n.B 1\nThe work failed, or robots were left out.\n"
    ".TP\n.B 2\nThe input cannot be used: an option, a file or a robot.\n"
    ".TP\n.B 128 + \\fIN\\fR\nStopped by signal \\fIN\\fR: 130 for Ctrl\\-C, 143 for \\fBkill\\fR.\n"
    ".SH ENVIRONMENT\n"
    ".TP\n.B MERCURY_FFMPEG\nThe program that encodes videos, unless \\fB\\-\\-ffmpeg\\fR names one.\n"
    ".TP\n.B COLUMNS\nThe width of help pages where standard output is not a terminal.\n";

}  // namespace

std::string man_page_name(const CommandDescription& command) {
  return command.words.empty() ? "mercury" : fmt::format("mercury-{}", fmt::join(command.words, "-"));
}

std::string man_page(const CommandDescription& command, const std::vector<CommandDescription>& all) {
  const std::string name = man_page_name(command);
  std::string help = command.help;
  if (help.ends_with(".")) help.pop_back();
  std::string page = fmt::format(".\\\" Made by mercury describe-options.\n.TH {} 1 \"\" \"{}\" \"Mercury\"\n",
                                 troff(upper_case(name)), program_version);
  page += fmt::format(".SH NAME\n{} \\- {}\n.SH SYNOPSIS\n{}", troff(name), troff(help), synopsis_of(command));
  page += commands_section(command, all) + options_section(command) + footer_section(command.footer) + common_sections;
  page += ".SH SEE ALSO\n";
  return page + (command.words.empty() ? "The folder \\fIdocs\\fR of the sources.\n" : "\\fBmercury\\fR(1)\n");
}

}  // namespace mercury
