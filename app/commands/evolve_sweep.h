// SPDX-License-Identifier: Apache-2.0
// `mercury evolve --seeds 1..20 --vary algorithm=ga,afpo`: the runs of a sweep (sweep.h) and their settings.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "app/options/command.h"
#include "mercury/run_folder.h"

namespace mercury {

class SweepOptions {
 public:
  // Adds the options to a command that has those of a run. The object must outlive it.
  void add_to(const Command& command);

  bool given() const { return !seeds_.empty() || !varied_.empty(); }

  struct Run {
    std::filesystem::path place;  // below the folder of the sweep: "algorithm=ga/seed-1"
    RunSettings settings;
  };
  // All runs, seed after seed, with the other options that were given to the command. Appends to `notes` what the user
  // should know of the first one. Throws InputError or ParameterError.
  std::vector<Run> runs(const Command& command, std::vector<std::string>& notes) const;

 private:
  std::string seeds_;
  std::vector<std::string> varied_;  // "algorithm=ga,afpo"
};

}  // namespace mercury
