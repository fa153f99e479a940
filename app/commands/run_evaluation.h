// SPDX-License-Identifier: Apache-2.0
// mercury run, in two ways with the same results: by an evaluator, which takes any number of robots in bounded memory,
// and in one simulation, which a recording and a repro need.
#pragma once

#include <memory>
#include <vector>

#include "app/base/interrupt.h"
#include "app/commands/run_checkpoints.h"
#include "app/commands/run_report.h"
#include "app/options/robot_options.h"
#include "app/recording/recorder.h"
#include "app/recording/repro.h"
#include "mercury/configuration.h"
#include "mercury/simulation.h"
#include "mercury/trials.h"

namespace mercury {

// Who the robot of a sequence is. Until the robot is there, its name is that of a random robot, or empty.
RobotIdentity identity_of(const RobotSequence& robots, std::size_t index);

// Simulates the robots, with a progress bar. If the user interrupts, the report holds those robots that
// have made all steps; if there is none yet, those that have come as far as the first. Robots that cannot be made are
// in the report, too. `seed` = of jitter. `results` begin with the first step. Throws InputError if all robots of a
// request cannot be made.
RunReport evaluate(const RobotSequence& robots, const Configuration& configuration, const TrialSettings& trials,
                   std::uint64_t seed, UnsavedResults& results);

// All robots of a sequence at once.
struct GatheredRobots {
  std::vector<std::shared_ptr<const Robot>> robots;
  std::vector<RobotIdentity> identities;  // of these
  std::vector<RobotResult> failed;        // those that cannot be made
};

// Makes the random robots on all cores. Reports as evaluate(). Throws InputError if they would not fit into memory with
// a recording, and Interrupted.
GatheredRobots gather(const RobotSequence& robots);

// Who takes part in the steps of a simulation.
struct StepObservers {
  Recorder* recorder = nullptr;
  ReproChanges* changes = nullptr;
  Checkpoints* checkpoints = nullptr;
};

// Says that the recording ended, and why.
void warn_without_recording(const RecordingFailure& failure);

// Simulates the robots of a simulation, `identities`, from where it stands, as one trial. If the user interrupts while
// they settle, the report holds no robot.
RunReport simulate(Simulation& simulation, std::vector<RobotIdentity> identities, const TrialSettings& trials,
                   const StepObservers& observers);
// The rest of a trial that began at step 0 and has come to `progress`.
RunReport resume(Simulation& simulation, std::vector<RobotIdentity> identities, const TrialSettings& trials,
                 const StepObservers& observers, TrialProgress progress);

// Puts robots that could not be made in their places.
void add_failed(RunReport& report, std::vector<RobotResult> failed);

}  // namespace mercury
