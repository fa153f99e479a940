// SPDX-License-Identifier: Apache-2.0
// Writes new robots into files, for all kinds of `mercury new`.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "app/options/command.h"
#include "app/options/output_options.h"
#include "mercury/robot.h"
#include "mercury/robot_file.h"

namespace mercury {

inline constexpr std::uint64_t most_new_robots = 1'000'000;  // of one command

// Makes the index-th robot of a seed. Throws InputError if it cannot be made.
using MakeRobot = std::function<Robot(std::uint64_t seed, std::uint64_t index)>;

// A robot, or the reason why it could not be made.
struct MadeRobot {
  std::optional<Robot> robot;
  std::string failure;
};

// Robots first .. first + count - 1 of a seed, made on all cores.
std::vector<MadeRobot> make_robots(const MakeRobot& make, std::uint64_t seed, std::uint64_t first, std::size_t count);

// Whether one of the robots that will be made may have this name. The files of these names are looked up before the
// work begins.
using RobotNames = std::function<bool(std::string_view name)>;

// The names of robots 0 .. count - 1, each of which ends with its number, after something that is no digit.
RobotNames numbered_names(std::function<std::string(std::uint64_t index)> name_of, std::uint64_t count);

// Where the robots of a command go, checked. Made by RobotOutput::open().
class RobotFiles {
 public:
  // Writes one robot to the file, or to NAME.json in the folder, and prints the file's name unless the robot itself is
  // printed. On an error no partial file is left. Throws InputError if the file exists, unless it may be replaced or
  // this object wrote it. Where another program has taken the name since open(), warns, and prints the name that this
  // file has (publish()).
  void write(const Robot& robot);
  bool renamed() const { return renamed_; }  // one of them

 private:
  friend class RobotOutput;
  std::filesystem::path file_of(const Robot& robot) const;

  std::filesystem::path path_;  // a file, or a folder
  bool is_file_ = false, may_replace_ = false, renamed_ = false;
  RobotFormat format_ = RobotFormat::json;
  std::set<std::filesystem::path> existing_, written_;  // files of the folder at open()
};

// The options for where new robots go, and how many.
class RobotOutput {
 public:
  // Adds the options to a command, with --count and --seed, or without. The object must outlive it.
  void add_to(const Command& command, const std::string& count_help = "How many robots (default 1)");
  void add_files_to(const Command& command);

  std::uint64_t count() const { return count_; }
  std::uint64_t seed() const { return seed_; }
  bool dry_run() const { return output_.dry_run(); }
  // Checks further outputs of the command by the same rules.
  OutputFiles other_outputs() const { return output_.files(); }

  // Checks the file or folder for this number of robots, see OutputFiles; `inputs` are read and must not be written.
  // Makes missing folders, unless it is a dry run. Throws InputError if --count cannot be used, or -o.
  RobotFiles open(std::uint64_t robots, const RobotNames& names,
                  const std::vector<std::filesystem::path>& inputs = {}) const;
  // The name of the one file without folder and extension; none if the robots go into a folder, or are printed.
  std::optional<std::string> file_stem() const;
  // For people: "eel.json", "standard output", "the folder my-robots (.cbor)".
  std::string description() const;

 private:
  bool names_file() const;
  void require_usable(std::uint64_t robots) const;

  std::string path_;  // a file (.json, .cbor), a folder, a device, "-"
  std::uint64_t count_ = 1;
  std::uint64_t seed_ = 1;
  std::string format_ = "json";  // of what has no extension
  OutputOptions output_;
};

// Makes robots 0 .. count - 1 of the seed and writes them. A robot that cannot be made is reported on standard
// error, and the next one is made. Returns the exit status: 0, or 1 if one could not be made or the user interrupted.
int write_robots(const RobotOutput& output, RobotFiles files, const MakeRobot& make);

}  // namespace mercury
