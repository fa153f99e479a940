// SPDX-License-Identifier: Apache-2.0
// A run of robots, saved on its way, so that another process goes on with it bit for bit.
//
// A checkpoint is a recording of one frame, so that everything that reads recordings reads it, with the group
// /checkpoint beside: what else the run has to know (docs/formats.md).
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "mercury/configuration.h"
#include "mercury/robot.h"
#include "mercury/simulation.h"
#include "mercury/trial_measures.h"

namespace mercury {

// A robot of the command's order, and where it comes from.
struct CheckpointRobot {
  std::uint64_t index = 0;
  std::string name, file, random;  // as in the results of a run; empty = has none
  std::string failure;             // why it could not be made; only of failed robots
  friend bool operator==(const CheckpointRobot&, const CheckpointRobot&) = default;
};

// A recording that the run was writing.
struct CheckpointRecording {
  std::string path, unfinished;  // the name it was to get, and the one it had
  std::int64_t frames = 0;       // that it has up to the checkpoint
  std::int64_t every = 1;        // steps
  std::optional<double> rate;    // instead: frames per second
  bool compressed = false, brains = false;
  friend bool operator==(const CheckpointRecording&, const CheckpointRecording&) = default;
};

// All of a run but its robots and their states.
struct CheckpointNotes {
  double seconds = 0, settle = 0;             // of the whole run [s]
  double strain_limit = 0;                    // [1]
  bool folding = false, upright = false;      // are measured: TrialSettings
  std::int64_t sampled = -1;                  // step of the last sample; -1 = nothing was measured yet
  std::vector<TrialMeasures::Sums> measures;  // of all samples so far, one per robot; none if nothing was measured yet
  std::vector<CheckpointRobot> robots;        // one per robot
  std::vector<CheckpointRobot> failed;        // those that could not be made
  std::optional<std::uint64_t> seed;          // of the random robots, if any
  std::optional<CheckpointRecording> recording;
};

struct Checkpoint {
  std::vector<Robot> robots;
  Configuration configuration;
  std::string device_name;  // for people
  DeviceKind backend = DeviceKind::cpu;
  BatchState state;
  CheckpointNotes notes;
};

// CPU or CUDA: states go on bit for bit where it is the same.
DeviceKind backend_of(const Simulation& simulation);

// Writes the file whole or not at all; one of that name is replaced. Throws InputError that begins with --checkpoint if
// the file cannot be created, and std::runtime_error if the disk is full.
void save_checkpoint(const std::filesystem::path& path, const Simulation& simulation, const CheckpointNotes& notes);

// Throws InputError, one line that begins with the path, unless the file is a complete checkpoint.
Checkpoint load_checkpoint(const std::filesystem::path& path);

}  // namespace mercury
