// SPDX-License-Identifier: Apache-2.0
// The robots that a command works on: files, folders, and random robots.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "app/options/command.h"
#include "app/options/generator_options.h"
#include "app/options/robot_inputs.h"
#include "mercury/configuration.h"
#include "mercury/evaluator.h"
#include "mercury/generator.h"
#include "mercury/host_memory.h"
#include "mercury/robot.h"
#include "mercury/run_folder.h"

namespace mercury {

// Robots that are made when they are asked for, as an Evaluator does.
struct RobotSequence {
  RobotSource source;  // throws InputError for a random robot that cannot be made
  std::size_t count = 0;
  std::vector<std::filesystem::path> files;  // of the first robots of the sequence, one each
  std::vector<RandomRobots> random;          // the last robots of the sequence, one request after the other
  // The environments that the robots are made for, see environment_of(): one per file, then one per request.
  std::vector<std::string> environments;
  Physics physics = Physics::paper;
  std::optional<RunSettings> run;  // if all robots are of one run folder

  // The environment that each robot is made for, one per robot.
  std::vector<std::string> environment_per_robot() const;
};

// Robots that are there.
struct LoadedRobots {
  std::vector<std::shared_ptr<const Robot>> robots;
  std::vector<std::filesystem::path> files;  // of the first robots, one each
  std::vector<std::string> environments;     // as in RobotSequence
  Physics physics = Physics::paper;
  std::optional<RunSettings> run;  // as in RobotSequence
};

inline constexpr const char* lively_help =
    "Of random robots, take the N that get farthest of 10 N in a quick trial, the liveliest first";
// Those robots, as requests of one each, tried with a progress bar. Throws InputError for too many, Interrupted.
std::vector<RandomRobots> chosen_lively(const RandomRobots& request, const Configuration& configuration);

class RobotOptions {
 public:
  // Adds the options to a command. The object must outlive it.
  void add_to(const Command& command);

  // Reads the files and makes the random robots, files first. Shows the progress. Throws InputError when there are
  // none, one cannot be used, or they would not fit into memory with what the command does; Interrupted after Ctrl-C.
  LoadedRobots load(const MemoryUse& use) const;
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

  // The robots of a file as load() reads them, and the robot that --random makes alone of such a request, with the
  // options of its kind. Throw InputError.
  std::vector<Robot> robots_in(const std::filesystem::path& file) const;
  Robot random_robot(const std::string& request) const;

  // The same in parts: the robots of the files, the files and folders as the user gave them, and the random robots to
  // make.
  std::vector<RobotFromFile> load_files() const;
  std::vector<std::filesystem::path> files() const { return files_.paths(); }
  bool has_random() const { return !random_.empty(); }
  // See RobotInputs.
  const std::vector<std::string>& chosen_of_runs() const { return files_.chosen_of_runs(); }
  std::vector<std::string> take_chosen_of_runs() { return files_.take_chosen_of_runs(); }
  std::vector<RandomRobots> random() const;  // with --lively, after their trials

  // What the options say that bodies are to be; robots of files may have real ones without a word.
  Physics physics() const;
  // What the robots of these files and the random ones are made for. Throws InputError for a mixture.
  Physics physics_with(std::span<const Robot* const> files) const;
  // Gives a robot of a file a real body if the options say so, and it has none. Throws InputError that names the file.
  void give_body(Robot& robot, const std::string& file) const;

  bool empty() const { return files_.empty() && random_.empty(); }

  // The exit status of a command that ended with `status`: 1 instead of 0 if robots were left out.
  int status(int status) const { return files_.status(status); }

  // The seed of the random robots; none if there are no random robots.
  std::optional<std::uint64_t> seed() const { return random_.empty() ? std::nullopt : std::optional(seed_); }
  // The same for what else is random, such as jitter.
  std::uint64_t seed_or_default() const { return seed_; }

 private:
  std::optional<RunSettings> settings_of_run() const;
  void require_robots() const;
  void require_robot_files() const;
  std::vector<Robot> random_robots(const RandomRobots& request) const;
  RandomRobots random_from(const std::string& request) const;

  RobotInputs files_;
  std::vector<std::string> random_;  // "voxel:12"
  std::uint64_t seed_ = 1;
  bool lively_ = false;
  GeneratorOptions generators_;
};

// Whether the robots that a command asks for fit into memory, before they are made.

// Measured on the CPU (docs/experiments.md): recorded; drawn.
inline constexpr MemoryUse recorded_memory{.per_robot = 20 << 10, .per_content = 3.5},
    drawn_memory{.per_robot = 36 << 10, .per_content = 7};

// Makes a few of the robots to see how large they are. Throws InputError("--random", memory_line()) if all of them
// would not fit into `usable` bytes, and Interrupted after Ctrl-C. A few robots are always accepted.
void require_memory_for(std::span<const RandomRobots> requests, const MemoryUse& use, std::size_t usable);

}  // namespace mercury
