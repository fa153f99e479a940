// SPDX-License-Identifier: Apache-2.0
#include "app/commands/command_list.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <map>
#include <set>

namespace mercury {
namespace {

std::string words_of(const CommandDescription& command) { return fmt::format("{}", fmt::join(command.words, " ")); }

// The options with a value, in all commands.
std::set<std::string> names_with_values(const std::vector<CommandDescription>& commands) {
  std::set<std::string> names;
  for (const CommandDescription& command : commands)
    for (const OptionDescription& option : command.options)
      if (!option.positional && option.kind != "switch") names.insert(option.names.begin(), option.names.end());
  return names;
}

// The commands and kinds that may follow the words of a command.
std::vector<const CommandDescription*> children_of(const CommandDescription& command,
                                                   const std::vector<CommandDescription>& all) {
  std::vector<const CommandDescription*> children;
  for (const CommandDescription& child : all)
    if (child.words.size() == command.words.size() + 1 &&
        std::equal(command.words.begin(), command.words.end(), child.words.begin()))
      children.push_back(&child);
  return children;
}

const OptionDescription* positional_of(const CommandDescription& command) {
  const auto found = std::ranges::find_if(command.options, &OptionDescription::positional);
  return found == command.options.end() ? nullptr : &*found;
}

bool takes_files(const OptionDescription& option) { return option.kind == "file" || option.kind == "path"; }

std::string replaced(std::string text, std::string_view from, const std::string& to) {
  for (std::size_t at = text.find(from); at != std::string::npos; at = text.find(from, at + to.size()))
    text.replace(at, from.size(), to);
  return text;
}

// Endings without dots: {"json", "cbor"}.
std::vector<std::string> endings_of(const OptionDescription& option) {
  std::vector<std::string> endings;
  for (const std::string& extension : option.extensions) endings.push_back(extension.substr(1));
  return endings;
}

// --- bash

std::string bash_action(const OptionDescription& option) {
  std::string action;
  if (!option.choices.empty())
    action += fmt::format("COMPREPLY+=($(compgen -W '{}' -- \"$cur\")); ", fmt::join(option.choices, " "));
  if (takes_files(option)) {
    const std::vector<std::string> endings = endings_of(option);
    action += fmt::format("_mercury_files{}{}; ", endings.empty() ? "" : " ", fmt::join(endings, " "));
  }
  if (option.kind == "folder") action += "compopt -o filenames 2> /dev/null; COMPREPLY+=($(compgen -d -- \"$cur\")); ";
  if (option.kind == "program") action += "COMPREPLY+=($(compgen -c -- \"$cur\")); ";
  return action;
}

// One case per action: *" --dt" if it is the same in all commands, else "run --csv" | "bench --csv".
std::string bash_values(const std::vector<CommandDescription>& commands) {
  std::map<std::string, std::map<std::string, std::vector<std::string>>> by_name;  // option, action, commands
  for (const CommandDescription& command : commands)
    for (const OptionDescription& option : command.options)
      if (!option.positional && option.kind != "switch")
        for (const std::string& name : option.names) by_name[name][bash_action(option)].push_back(words_of(command));
  std::map<std::string, std::vector<std::string>> patterns;
  for (const auto& [name, actions] : by_name)
    for (const auto& [action, of] : actions) {
      if (actions.size() == 1) patterns[action].push_back(fmt::format("*' {}'", name));
      if (actions.size() > 1)
        for (const std::string& command : of) patterns[action].push_back(fmt::format("'{} {}'", command, name));
    }
  std::string text;
  for (const auto& [action, of] : patterns) text += fmt::format("    {}) {}return ;;\n", fmt::join(of, " | "), action);
  return text;
}

std::string bash_command(const CommandDescription& command, const std::vector<CommandDescription>& all) {
  std::vector<std::string> options, children;
  for (const OptionDescription& option : command.options)
    if (!option.positional) options.insert(options.end(), option.names.begin(), option.names.end());
  for (const CommandDescription* child : children_of(command, all)) children.push_back(child->words.back());
  std::string action = fmt::format("COMPREPLY=($(compgen -W '{}' -- \"$cur\")); ", fmt::join(children, " "));
  if (!command.family) action = positional_of(command) ? bash_action(*positional_of(command)) : "";
  if (action.empty()) action = ":; ";
  return fmt::format(
      "    '{}')\n"
      "      if [[ $cur == -* ]]; then COMPREPLY=($(compgen -W '{}' -- \"$cur\"))\n"
      "      else {}fi ;;\n",
      words_of(command), fmt::join(options, " "), action);
}

// --- The words of a command, in bash and zsh: "run", "new voxel".

std::string word_patterns(const std::vector<CommandDescription>& commands) {
  std::vector<std::string> patterns;
  for (const CommandDescription& command : commands) {
    if (command.words.empty()) continue;
    const std::vector<std::string> above(command.words.begin(), command.words.end() - 1);
    patterns.push_back(fmt::format("'{} {}'", fmt::join(above, " "), command.words.back()));
  }
  return fmt::format("{}", fmt::join(patterns, " | "));
}

// --- zsh

std::string zsh_text(const std::string& text) {
  std::string result;
  for (const char letter : text) {
    if (letter == '[' || letter == ']' || letter == ':' || letter == '\\') result += '\\';
    result += letter;
  }
  return replaced(result, "'", "'\\''");
}

std::string zsh_action(const OptionDescription& option) {
  std::string files;
  if (takes_files(option) && option.extensions.empty()) files = "_files";
  if (takes_files(option) && !option.extensions.empty())
    files = fmt::format("_files -g \"*.({})\"", fmt::join(endings_of(option), "|"));
  if (option.kind == "folder") files = "_files -/";
  if (option.kind == "program") files = "_command_names -e";
  if (option.choices.empty()) return files.empty() ? " " : files;
  const std::string words = replaced(fmt::format("{}", fmt::join(option.choices, " ")), ":", "\\:");
  return files.empty() ? "(" + words + ")" : "{compadd " + words + "; " + files + "}";
}

std::string zsh_command(const CommandDescription& command, const std::vector<CommandDescription>& all) {
  std::string text = fmt::format("    ('{}')\n      _arguments -s", words_of(command));
  for (const OptionDescription& option : command.options)
    for (const std::string& name : option.names) {
      if (option.positional) continue;
      text += fmt::format(" \\\n        '{}{}", option.repeatable ? "*" : "", name);
      const bool is_switch = option.kind == "switch";
      text += (!is_switch && name.starts_with("--") ? "=[" : "[") + zsh_text(option.help) + "]";
      text += is_switch ? "'" : ":" + zsh_text(option.form) + ":" + zsh_action(option) + "'";
    }
  std::string rest = "*: : ";
  if (const OptionDescription* positional = positional_of(command))
    rest = "*:" + positional->names.front() + ":" + zsh_action(*positional);
  if (command.family) {
    rest = "*:command:((";
    for (const CommandDescription* child : children_of(command, all))
      rest += fmt::format("{}\\:\"{}\" ", child->words.back(), zsh_text(child->help));
    rest += "))";
  }
  return text + fmt::format(" \\\n        '{}' ;;\n", rest);
}

// --- fish

std::string fish_text(const std::string& text) {
  return "'" + replaced(replaced(text, "\\", "\\\\"), "'", "\\'") + "'";
}

std::string fish_value(const OptionDescription& option) {
  std::string words = fmt::format("{}", fmt::join(option.choices, " "));
  if (takes_files(option)) {
    if (option.extensions.empty()) return " -r -F" + (words.empty() ? "" : " -a " + fish_text(words));
    words += fmt::format(" (__mercury_files {})", fmt::join(option.extensions, " "));
  }
  if (option.kind == "folder") words += "(__fish_complete_directories)";
  if (option.kind == "program") words += "(__fish_complete_command)";
  return words.empty() ? "" : " -a " + fish_text(words);
}

std::string fish_command(const CommandDescription& command, const std::vector<CommandDescription>& all) {
  const std::string begin = fmt::format("complete -c mercury -n \"__mercury_at '{}'\"", words_of(command));
  std::string text;
  for (const CommandDescription* child : children_of(command, all))
    text += fmt::format("{} -a {} -d {}\n", begin, child->words.back(), fish_text(child->help));
  for (const OptionDescription& option : command.options) {
    text += begin;
    if (!option.positional)
      for (const std::string& name : option.names)
        text += name.starts_with("--") ? " -l " + name.substr(2) : " -s " + name.substr(1);
    if (!option.positional && option.kind != "switch") text += " -x";
    text += fish_value(option) + " -d " + fish_text(option.help) + "\n";
  }
  return replaced(text, " -x -r -F", " -r -F");
}

}  // namespace

std::string bash_completion(const std::vector<CommandDescription>& commands) {
  std::string text =
      fmt::format(R"(# bash completion of mercury. Made by mercury describe-options.

# Folders, and files with one of these endings; all files without endings.
_mercury_files() {{
  local IFS=$'\n' ending
  compopt -o filenames 2> /dev/null
  if (( $# == 0 )); then COMPREPLY+=($(compgen -f -- "$cur")); return; fi
  COMPREPLY+=($(compgen -d -- "$cur"))
  for ending; do COMPREPLY+=($(compgen -f -X "!*.$ending" -- "$cur")); done
}}

_mercury_offers() {{
  local cur=${{COMP_WORDS[COMP_CWORD]}} option=${{COMP_WORDS[COMP_CWORD-1]}} command= word i
  COMPREPLY=()
  # The words of the command, of which values of options are none.
  for (( i = 1; i < COMP_CWORD; ++i )); do
    word=${{COMP_WORDS[i]}}
    case $word in
      {})
        (( ++i )); if [[ ${{COMP_WORDS[i]}} == = ]]; then (( ++i )); fi ;;
      *)
        case "$command $word" in {}) command="${{command:+$command }}$word" ;; esac ;;
    esac
  done
  # bash splits --solver=xpbd at the sign.
  if [[ $cur == = ]]; then cur=
  elif [[ $option == = ]]; then option=${{COMP_WORDS[COMP_CWORD-2]}}
  fi
  # It splits sample:eel, too, and replaces what follows the colon.
  if [[ $cur == : && $option == sample ]]; then cur=sample: sample=yes option=${{COMP_WORDS[COMP_CWORD-2]}}
  elif [[ $option == : && ${{COMP_WORDS[COMP_CWORD-2]}} == sample ]]; then
    cur=sample:$cur sample=yes option=${{COMP_WORDS[COMP_CWORD-3]}}
  fi
  case "$command $option" in
{}  esac
  case "$command" in
)",
                  fmt::join(names_with_values(commands), " | "), word_patterns(commands), bash_values(commands));
  for (const CommandDescription& command : commands) text += bash_command(command, commands);
  return text + R"(  esac
}

_mercury() {
  local sample= others
  _mercury_offers
  # The colon of a sample would be escaped as in the name of a file.
  others="${COMPREPLY[*]##sample:*}"
  if [[ -z ${others// } ]]; then compopt +o filenames 2> /dev/null; fi
  if [[ $sample ]]; then COMPREPLY=("${COMPREPLY[@]#sample:}"); fi
}
complete -F _mercury mercury
)";
}

std::string zsh_completion(const std::vector<CommandDescription>& commands) {
  std::string text = fmt::format(R"(#compdef mercury
# zsh completion of mercury. Made by mercury describe-options.

_mercury() {{
  local word command= i
  # The words of the command, of which values of options are none.
  for (( i = 2; i < CURRENT; ++i )); do
    word=$words[i]
    case $word in
      ({}) (( ++i )) ;;
      (*) case "$command $word" in ({}) command="${{command:+$command }}$word" ;; esac ;;
    esac
  done
  case "$command" in
)",
                                 fmt::join(names_with_values(commands), " | "), word_patterns(commands));
  for (const CommandDescription& command : commands) text += zsh_command(command, commands);
  return text + "  esac\n}\n\n_mercury \"$@\"\n";
}

std::string fish_completion(const std::vector<CommandDescription>& commands) {
  std::vector<std::string> known;
  for (const CommandDescription& command : commands)
    if (!command.words.empty()) known.push_back("'" + words_of(command) + "'");
  std::string text = fmt::format(R"(# fish completion of mercury. Made by mercury describe-options.

# Whether the words of the command so far are these; values of options are none of them.
function __mercury_at
    set -l command ''
    set -l is_value no
    for word in (commandline -opc)[2..]
        if test $is_value = yes
            set is_value no
        else if contains -- $word {}
            set is_value yes
        else if contains -- (string trim -- "$command $word") {}
            set command (string trim -- "$command $word")
        end
    end
    test "$command" = "$argv[1]"
end

# Folders, and files with one of these endings.
function __mercury_files
    set -l begin (string replace -r -- '^--[^=]*=' '' (commandline -ct))
    __fish_complete_directories "$begin" ''
    for ending in $argv
        for file in $begin*$ending
            echo $file
        end
    end
end

complete -c mercury -f
)",
                                 fmt::join(names_with_values(commands), " "), fmt::join(known, " "));
  for (const CommandDescription& command : commands) text += fish_command(command, commands);
  return text;
}

}  // namespace mercury
