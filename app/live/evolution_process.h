// SPDX-License-Identifier: Apache-2.0
// Evolution in the background of the window: the program itself as a child process, `mercury evolve RUN ...`.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "app/base/child_process.h"
#include "mercury/configuration.h"

namespace mercury {

// A new run that starts from robots of the window. What is not named here has the default of `mercury evolve`.
struct EvolveRequest {
  std::filesystem::path folder;  // of the run; new or empty
  std::string algorithm = "afpo";
  std::string genes = "body";  // what changes: "body", "muscles" or "both"
  std::string objective = "distance";
  int population = 64;
  int generations = 50;
  double seconds = 10;  // of each trial [s]
  friend bool operator==(const EvolveRequest&, const EvolveRequest&) = default;
};

// The words after `mercury`. `founders`: a folder of robot files.
std::vector<std::string> evolve_arguments(const EvolveRequest& request, const Configuration& configuration,
                                          const std::filesystem::path& founders);

// The file of the running program.
std::filesystem::path this_program();

// A folder of files that are needed for a while; the destructor removes it.
class TemporaryFolder {
 public:
  TemporaryFolder();  // throws std::system_error
  ~TemporaryFolder();
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;
  const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_;
};

class EvolutionProcess {
 public:
  // Throws CannotStart.
  EvolutionProcess(const std::filesystem::path& program, const std::vector<std::string>& arguments)
      : process_(program.string(), arguments) {}
  ~EvolutionProcess();  // stops it and waits some seconds until it has; kills it after that

  bool running() { return process_.running(); }
  // Asks it to stop in an orderly way, as Ctrl-C does: the run can be resumed.
  void stop();
  bool stopped() const { return stopped_; }
  // It runs on when this object is destroyed.
  void leave_running() { process_.release(); }
  // Why it ended, in one line, if not by itself: its last message, or its exit status. Empty = it ended well.
  std::string failure();

 private:
  ChildProcess process_;
  bool stopped_ = false;
};

}  // namespace mercury
