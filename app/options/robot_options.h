// SPDX-License-Identifier: Apache-2.0
// The robots that a command works on: files, folders, and random robots.
#pragma once

#include <CLI/CLI.hpp>

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "app/options/generator_options.h"
#include "mercury/evaluator.h"
#include "mercury/robot.h"

namespace mercury {

// Robots that are made when they are asked for, as an Evaluator does.
struct RobotSequence {
  RobotSource source;  // throws InputError for a random robot that cannot be made
  std::size_t count = 0;
  std::vector<std::filesystem::path> files;  // of the first robots of the sequence, one each
  std::vector<RandomRobots> random;          // the last robots of the sequence, one request after the other
  // The environments that the robots are made for, see environment_of().
  std::vector<std::string> environments;
};

class RobotOptions {
 public:
  // Adds the options to a command. The object must outlive it.
  void add_to(CLI::App& command);

  // Reads the files and makes the random robots, files first. Throws InputError when there are none, or one cannot be
  // used.
  std::vector<Robot> load() const;
  // The robots of load(), in the same order. Those of files are read at once, with the same errors; random robots are
  // made by the source. A random robot that load() leaves out has its place in the sequence.
  RobotSequence sequence() const;

  // The trajectory file, if one was given. Throws InputError if robots were given with it.
  std::optional<std::filesystem::path> recording() const;

  // The *.repro file, if one was given. Throws InputError if robots were given with it.
  std::optional<std::filesystem::path> repro() const;

  // The file or folder of a kind that is given alone, if there is one. Throws InputError(its name, why) if robots were
  // given with it.
  std::optional<std::filesystem::path> alone(bool (*is_such)(const std::filesystem::path&), const char* why) const;

  // The same in parts: the robots of the files, the files' names, and the random robots to make.
  std::vector<Robot> load_files() const;
  std::vector<std::filesystem::path> files() const { return {paths_.begin(), paths_.end()}; }
  std::vector<RandomRobots> random() const;

  bool empty() const { return paths_.empty() && random_.empty(); }

  // The seed of the random robots; none if there are no random robots.
  std::optional<std::uint64_t> seed() const { return random_.empty() ? std::nullopt : std::optional(seed_); }

 private:
  void require_robots() const;
  void require_robot_files() const;
  RandomRobots random_from(const std::string& request) const;

  std::vector<std::string> paths_;   // files and folders
  std::vector<std::string> random_;  // "voxel:12"
  std::uint64_t seed_ = 1;
  GeneratorOptions generators_;
};

}  // namespace mercury
