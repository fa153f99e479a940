// SPDX-License-Identifier: Apache-2.0
// Options from a TOML file: --config FILE.toml, and scenes.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "app/options/command.h"

namespace mercury {

// The options of a TOML file as arguments of the command line. A key is the name of an option without its dashes.
// Values are numbers, text, true or false, [x, y, z] for vectors and ["a", "b"] for options that may be repeated. Keys
// at the top level apply to every command that has the option. Keys in a table such as [render] or [new] apply to that
// command only, those in [new.voxel] to that kind only; they override the keys above them.
//
// A scene (scene_file.h) has such keys as well, and keys of its own: `format`, `version`, `robots`, and the table
// [camera].
class ConfigFile {
 public:
  enum class Content { options, scene };
  // Takes the options that `command` has and that are not on the command line `given`. Throws InputError
  // ("sim.toml:3: ...") if the file cannot be read, or if a table or key is not a command or an option of it; also in
  // tables of other commands. Does not wait for pipes: it takes regular files only.
  ConfigFile(const std::string& path, const Command& program, const Command& command,
             const std::vector<std::string>& given, Content content = Content::options);

  const std::vector<std::string>& arguments() const { return arguments_; }
  // Of a scene: the robot files, as paths from the working folder.
  const std::vector<std::string>& robots() const { return robots_; }
  // The error's text, preceded by file and line if it begins with the name of an option that came from the file.
  std::string located(const std::string& error) const;

 private:
  // `Table` and `Node` are those of toml++, which no header of ours includes.
  template <class Table>
  void take(const Table& table, const Command& scope);
  template <class Table>
  void take_scene(Table& table);
  template <class Table>
  void take_camera(const Table& camera);
  template <class Node>
  void take_camera_option(const std::string& value, const Node& node);
  template <class Node>
  void take_key(const std::string& key, const Node& value, const Command& scope);
  template <class Node>
  std::string where(const Node& node) const;  // "sim.toml:3"

  std::string path_;
  const Command& command_;
  std::vector<std::string> given_;
  Content content_;
  std::vector<std::string> arguments_, robots_;
  std::map<std::string, unsigned> lines_;  // by option: "--dt"
};

// Whether the option is among the arguments of a command line.
bool is_given(const Option& option, const std::vector<std::string>& given);

// The last value of --config on a command line; empty = not given, or given empty.
std::string config_path_in(const std::vector<std::string>& arguments);

}  // namespace mercury
