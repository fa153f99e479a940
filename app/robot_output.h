// Many new robots into files: what all of `mercury new` has in common.
#pragma once

#include <CLI/CLI.hpp>

#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>

#include "sim/robot.h"

namespace mercury {

// Where new robots go, and how many.
struct RobotOutput {
  std::string path;             // a file (.json, .cbor) or a folder
  std::uint64_t count = 1;
  std::uint64_t seed = 1;
  std::string format = "json";  // of files in a folder
  bool force = false;           // replace files that exist
  std::string config;

  // Adds the options to a command. The object must outlive it.
  void add_to(CLI::App& command);
};

// Makes the index-th robot of a seed.
using MakeRobot = std::function<Robot(std::uint64_t seed, std::uint64_t index)>;

// Makes the robots and writes them one by one, each file whole or not at all, into the file or as NAME.json into the
// folder; prints the names of the files. A file that exists already ends it with an InputError that names it, unless
// told otherwise. A robot that cannot be made (InputError) is told on standard error, and the next one made.
// Returns the exit status: 0, or 1 if one could not be made or the user interrupted.
int write_robots(const RobotOutput& output, const MakeRobot& make);

}  // namespace mercury
