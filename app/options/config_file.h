// SPDX-License-Identifier: Apache-2.0
// --config FILE.toml: options from a file.
#pragma once

#include <CLI/CLI.hpp>

#include <map>
#include <string>
#include <vector>

namespace mercury {

// The options of a TOML file as arguments of the command line. A key is the name of an option without its dashes.
// Values are numbers, text, true or false, [x, y, z] for vectors and ["a", "b"] for options that may be repeated. Keys
// at the top level apply to every command that has the option. Keys in a table such as [render] apply to that command
// only and override the others.
class ConfigFile {
 public:
  // Takes the options that `command` has and that are not on the command line `given`. Throws InputError
  // ("sim.toml:3: ...") if the file cannot be read or no command of `program` has an option with the name of a key.
  ConfigFile(const std::string& path, CLI::App& program, CLI::App& command, const std::vector<std::string>& given);

  const std::vector<std::string>& arguments() const { return arguments_; }
  // The error's text, preceded by file and line if it begins with the name of an option that came from the file.
  std::string located(const std::string& error) const;

 private:
  std::string path_;
  std::vector<std::string> arguments_;
  std::map<std::string, unsigned> lines_;  // by option: "--dt"
};

// The value of --config on a command line; empty = not given.
std::string config_path_in(const std::vector<std::string>& arguments);

}  // namespace mercury
