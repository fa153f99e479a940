// SPDX-License-Identifier: Apache-2.0
// Writes new robots into files, for all kinds of `mercury new`.
#pragma once

#include <CLI/CLI.hpp>

#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "mercury/robot.h"

namespace mercury {

// Makes the index-th robot of a seed. Throws InputError if it cannot be made.
using MakeRobot = std::function<Robot(std::uint64_t seed, std::uint64_t index)>;

// A robot, or the reason why it could not be made.
struct MadeRobot {
  std::optional<Robot> robot;
  std::string failure;
};

// Robots first .. first + count - 1 of a seed, made on all cores.
std::vector<MadeRobot> make_robots(const MakeRobot& make, std::uint64_t seed, std::uint64_t first, std::size_t count);

// Where new robots go, and how many.
class RobotOutput {
 public:
  // Adds the options to a command, with --count and --seed, or without. The object must outlive it.
  void add_to(CLI::App& command, const std::string& count_help = "How many robots (default 1)");
  void add_files_to(CLI::App& command);

  std::uint64_t count() const { return count_; }
  std::uint64_t seed() const { return seed_; }

  // Creates the folders. Throws InputError if --count is 0, or if the name cannot be used for this number of robots.
  void prepare(std::uint64_t robots) const;
  void prepare() const { prepare(count_); }
  // The name of the one file without folder and extension; none if the robots go into a folder.
  std::optional<std::string> file_stem() const;
  // Writes one robot to the file, or to NAME.json in the folder, and prints the file's name. On an error no partial
  // file is left. Throws InputError if the file exists, unless --force is given.
  void write(const Robot& robot) const;

 private:
  bool names_file() const;

  std::string path_;  // a file (.json, .cbor) or a folder
  std::uint64_t count_ = 1;
  std::uint64_t seed_ = 1;
  std::string format_ = "json";  // of files in a folder
  bool force_ = false;           // replace files that exist
};

// Makes robots 0 .. count - 1 of the seed and writes them. A robot that cannot be made is reported on standard
// error, and the next one is made. Returns the exit status: 0, or 1 if one could not be made or the user interrupted.
int write_robots(const RobotOutput& output, const MakeRobot& make);

}  // namespace mercury
