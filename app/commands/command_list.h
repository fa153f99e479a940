// SPDX-License-Identifier: Apache-2.0
// All commands and options of the program as plain data. Help pages, man pages, completion and the list for other
// programs (`mercury describe-options json`) are made from it.
#pragma once

#include <string>
#include <vector>

#include "app/options/command.h"

namespace mercury {

struct OptionDescription {
  std::vector<std::string> names;  // "-o", "--output"; "ROBOTS" of a positional argument
  std::string form;                // of the value: "FILE.h5", "force|xpbd"; empty for a switch
  // "switch" (no value), "number", "whole number", "choice" (one of `choices`, nothing else), "file", "folder", "path"
  // (a file or a folder), "program", "text".
  std::string kind;
  std::vector<std::string> choices;  // words that are accepted or, unless kind is "choice", that a value may begin with
  std::vector<std::string> extensions;  // ".json"; of files that are read or written. Empty = any
  std::string help, group;
  bool positional = false, required = false;
  bool repeatable = false;    // each occurrence counts; otherwise the last one
  bool many = false;          // takes several values: ROBOTS ...
  bool first_screen = false;  // -h shows it
};

struct CommandDescription {
  std::vector<std::string> words;  // {"new", "voxel"}; empty for the program itself
  std::string help, footer;
  std::vector<OptionDescription> options;  // positional arguments first, then in the order of the help
  bool family = false;                     // needs another word, as "new" does

  std::string name() const;  // "mercury new voxel"
};

// The explanation and examples below the help of a command; CLI11 passes those of the program on to commands without.
std::string footer_of(const Command& command);

// The program, its commands and the kinds of each, parents first.
std::vector<CommandDescription> command_list(const Command& program);

OptionDescription description_of(const Option& option);
// The options of one command, in the same form.
std::vector<OptionDescription> options_of(const Command& command);

// The list as JSON:
//
//   {"format": "mercury-options", "version": 1, "program": "mercury 0.2.0",
//    "commands": [{"words": ["new", "voxel"], "family": false, "help": "Random voxel robots",
//                  "options": [{"names": ["-o", "--output"], "kind": "path", "form": "FILE|FOLDER", "choices": [],
//                               "extensions": [".json", ".cbor"], "help": "...", "group": "Options",
//                               "positional": false, "required": true, "repeatable": false, "many": false}, ...]},
//                 ...]}
//
// Members are those of the structs above. The first command has no words: it is the program with its global options,
// which every command takes too.
std::string json_of(const std::vector<CommandDescription>& commands);

// Completion scripts for shells. They complete commands, options, words that options accept, and files with the right
// endings.
std::string bash_completion(const std::vector<CommandDescription>& commands);
std::string zsh_completion(const std::vector<CommandDescription>& commands);
std::string fish_completion(const std::vector<CommandDescription>& commands);

// "mercury-new-voxel"; the page is the file mercury-new-voxel.1.
std::string man_page_name(const CommandDescription& command);
// The manual page of one of the commands, in the troff macros "man".
std::string man_page(const CommandDescription& command, const std::vector<CommandDescription>& all);

// Usage, arguments, options by group, explanation and examples, in lines of at most `columns` letters; only words and
// examples that are longer stand out. A `brief` page is one screen: usage, arguments, the options that are declared
// on_first_screen(), and how to see the rest.
std::string help_page(const Command& command, bool brief, int columns);

// Titles of groups of options in the order of the page: what belongs to this command alone first, what all have last.
std::vector<std::string> groups_of(const std::vector<OptionDescription>& options);

// The width of the terminal that standard output is, else COLUMNS, else 80; from 40 to 100.
int columns_of_standard_output();

// The text in lines of at most `columns` letters, broken at spaces; words that are longer break after commas.
std::vector<std::string> wrapped(const std::string& text, std::size_t columns);

}  // namespace mercury
