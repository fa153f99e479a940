// SPDX-License-Identifier: Apache-2.0
// Robot files on a command line: the one way in which commands read them.
#pragma once

#include <cstddef>
#include <filesystem>
#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "app/options/command.h"
#include "mercury/robot.h"

namespace mercury {

inline constexpr const char* standard_input = "-";

// A robot and where it came from: its file, or standard_input.
struct RobotFromFile {
  std::filesystem::path file;
  Robot robot;
};

class RobotInputs {
 public:
  // Adds the argument ROBOTS and the options below to a command. The object must outlive it.
  void add_to(const Command& command,
              const std::string& description = "Robot files (.json, .cbor), folders, samples (sample:eel)");
  // Adds --recursive, --keep-going and --robot alone.
  void add_options_to(const Command& command);

  // As the user gave them, and the files of sample robots. Throws InputError for an unknown sample.
  std::vector<std::filesystem::path> paths() const;
  bool empty() const { return paths_.empty(); }
  // What --robot says; it is forgotten by taking it. load() refuses it unless one of the paths is a run folder.
  const std::vector<std::string>& chosen_of_runs() const { return of_runs_; }
  std::vector<std::string> take_chosen_of_runs() { return std::exchange(of_runs_, {}); }

  // Reads the robots of files and folders, and of standard input for "-". Shows the progress, and throws Interrupted
  // after Ctrl-C. Throws InputError for a file that cannot be used; with --keep-going, reports it and goes on. `accept`
  // may throw InputError for a robot that the command cannot use. A run folder stands for the robots in its best/, or
  // for those that --robot chooses.
  std::vector<RobotFromFile> load(const std::vector<std::filesystem::path>& paths,
                                  const std::function<void(const Robot&)>& accept = {}) const;
  // The same of all paths. Throws InputError as well if there are paths, but no robot is left.
  std::vector<RobotFromFile> load(const std::function<void(const Robot&)>& accept = {}) const;

  // The exit status of a command that ended with `status`: 1 instead of 0 if robots were left out.
  int status(int status) const { return status == 0 && left_out_ > 0 ? 1 : status; }
  // Reports a robot that was left out for another reason.
  void leave_out(const std::string& reason) const;

 private:
  void keep_going_after(const std::string& error) const;
  std::vector<std::filesystem::path> listed(const std::vector<std::filesystem::path>& paths) const;
  void load_run(const std::filesystem::path& folder, std::vector<RobotFromFile>& robots,
                const std::function<void(const Robot&)>& accept) const;
  void load_standard_input(std::vector<RobotFromFile>& robots, const std::function<void(const Robot&)>& accept) const;

  std::vector<std::string> paths_, of_runs_;
  bool recursive_ = false, keep_going_ = false;
  mutable std::size_t left_out_ = 0;
};

// The robots without their files.
std::vector<Robot> robots_of(std::vector<RobotFromFile> loaded);

}  // namespace mercury
