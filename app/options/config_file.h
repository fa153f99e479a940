// SPDX-License-Identifier: Apache-2.0
// --config FILE.toml: options from a file.
#pragma once

#include <CLI/CLI.hpp>

#include <map>
#include <string>
#include <vector>

namespace mercury {

// The options of a TOML file, as arguments of the command line. A key is an option's name without its dashes; numbers,
// text, true/false, [x, y, z] for vectors and ["a", "b"] for options that may be repeated. Keys of the top level apply
// to every command that has them; those of a table such as [render] to that command alone, and over the others.
class ConfigFile {
 public:
  // Takes what `command` (its full name: "run", "new voxel") has and `given`, the command line, does not say itself.
  // Throws InputError "sim.toml:3: ..." for a file that cannot be read or a key that no command of `program` has.
  ConfigFile(const std::string& path, CLI::App& program, CLI::App& command, const std::vector<std::string>& given);

  const std::vector<std::string>& arguments() const { return arguments_; }
  // An error's text with file and line before it, when it begins with the name of an option that came from the file.
  std::string located(const std::string& error) const;

 private:
  std::string path_;
  std::vector<std::string> arguments_;
  std::map<std::string, unsigned> lines_;  // by option, as in "--dt"
};

// The value of --config on a command line; empty = none.
std::string config_path_in(const std::vector<std::string>& arguments);

}  // namespace mercury
