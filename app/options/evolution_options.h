// SPDX-License-Identifier: Apache-2.0
// The options of `mercury evolve` that describe a run: what evolves, how, in which trials.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "app/options/command.h"
#include "app/options/generator_options.h"
#include "app/options/robot_inputs.h"
#include "app/options/simulation_options.h"
#include "mercury/run_folder.h"

namespace mercury {

class EvolutionOptions {
 public:
  // Adds the options to a command. The object must outlive it.
  void add_to(const Command& command);

  // The settings of a new run. Reads the robots to start from. Appends to `notes` what the user should know. Throws
  // InputError or ParameterError for options that cannot be used.
  RunSettings settings(std::vector<std::string>& notes) const;

  // The exit status of a command that ended with `status`: 1 instead of 0 if robots to start from were left out.
  int status(int status) const { return founder_files_.status(status); }

  // What may change when a run goes on: throws InputError for any other option that was given.
  void require_only_what_may_change(const Command& command) const;
  std::optional<int> generations() const;  // if it was given
  // Puts the device and threads that were given into the settings of a run that goes on.
  void choose_device(const Command& command, Configuration& configuration) const;

 private:
  GenomeSpaceRequest space(std::vector<std::string>& paths) const;
  std::vector<Robot> founders(const std::vector<std::string>& paths) const;
  void set_size(GenomeSpaceRequest& space, const std::string& size) const;
  AlgorithmSettings algorithm() const;

  std::optional<Command> command_;
  RobotInputs founder_files_;
  std::vector<std::string> from_;  // "voxel:6x4x4", or files and folders
  GeneratorOptions generators_;
  SimulationOptions simulation_;
  std::string genes_ = "body";
  std::optional<std::string> algorithm_;
  std::vector<std::string> objectives_, axes_;
  EvolutionSettings given_;  // what needs no further reading
  MuscleMutation muscles_;
  BrainGrowth growth_;
};

}  // namespace mercury
