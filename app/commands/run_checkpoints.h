// SPDX-License-Identifier: Apache-2.0
// mercury run --checkpoint and --resume: the state of a run is saved now and then, and another process goes on with it.
#pragma once

#include <chrono>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "app/commands/robot_results.h"
#include "app/recording/checkpoint.h"
#include "app/recording/recorder.h"
#include "mercury/trial_measures.h"

namespace mercury {

// How far a trial has come, beside the simulation.
struct TrialProgress {
  std::int64_t sampled = -1;            // step of the last sample; -1 = the robots still settle
  std::vector<TrialMeasures> measures;  // one per robot; none while they settle
};

// Writes a run's checkpoints. A checkpoint that cannot be written does not end the run: the last good one stays.
class Checkpoints {
 public:
  // `period` = between two checkpoints, of wall time [s]. The first is due one period from now.
  Checkpoints(std::filesystem::path path, double period, CheckpointNotes notes)
      : path_(std::move(path)), period_(period), notes_(std::move(notes)) {}

  bool due() const;
  // Flushes the recorder, if there is one, so that the checkpoint's frames are in its file.
  void write(const Simulation& simulation, const TrialProgress& progress, Recorder* recorder);
  // Whether the last write failed, or has another name than was wanted.
  bool failed() const { return failed_ || renamed_; }

 private:
  using Clock = std::chrono::steady_clock;
  std::filesystem::path path_;
  double period_;
  CheckpointNotes notes_;
  bool failed_ = false, renamed_ = false;
  Clock::time_point last_ = Clock::now();
};

CheckpointRobot checkpoint_robot_of(const RobotIdentity& identity, const std::string& failure = {});
RobotIdentity identity_of(const CheckpointRobot& robot);

// A run from a checkpoint on.
struct ResumedRun {
  Simulation simulation;
  std::vector<RobotIdentity> identities;
  std::vector<RobotResult> failed;
  TrialProgress progress;
  CheckpointNotes notes;
};
// `device`: what to go on with; one of automatic kind gives the kind that the checkpoint is from, where this machine
// has it. Warns if the run cannot go on bit for bit. Throws InputError and DeviceError.
ResumedRun resumed_run(Checkpoint checkpoint, const std::filesystem::path& file, const Device& device);

// The recording that a checkpoint's run was writing, under its temporary name if it was killed. Throws InputError if it
// is not there.
std::unique_ptr<TrajectoryReader> recording_before(const CheckpointRecording& recording);

}  // namespace mercury
