// SPDX-License-Identifier: Apache-2.0
#include "app/commands/run_checkpoints.h"

#include <fmt/format.h>

#include <exception>
#include <utility>

#include "app/base/messages.h"
#include "app/base/progress.h"
#include "mercury/cuda_devices.h"
#include "mercury/error.h"
#include "mercury/file_links.h"

namespace mercury {
namespace {

Device device_for(const Checkpoint& checkpoint, Device wanted) {
  if (wanted.threads == 0) wanted.threads = checkpoint.configuration.device.threads;
  if (wanted.kind != DeviceKind::automatic) return wanted;
  wanted.kind =
      checkpoint.backend == DeviceKind::cuda && cuda_device_count() == 0 ? DeviceKind::cpu : checkpoint.backend;
  return wanted;
}

}  // namespace

bool Checkpoints::due() const { return std::chrono::duration<double>(Clock::now() - last_).count() >= period_; }

void Checkpoints::write(const Simulation& simulation, const TrialProgress& progress, Recorder* recorder) {
  try {
    notes_.sampled = progress.sampled;
    notes_.measures.clear();
    for (const TrialMeasures& measures : progress.measures) notes_.measures.push_back(measures.sums());
    if (!recorder) notes_.recording.reset();  // what a full disk ended is not continued
    if (recorder && notes_.recording) {
      recorder->flush();
      notes_.recording->unfinished = std::filesystem::absolute(recorder->unfinished_path()).string();
      notes_.recording->frames = recorder->frames();
    }
    save_checkpoint(path_, simulation, notes_);
    failed_ = false;
  } catch (const NameTaken& taken) {  // the next ones replace this one
    warn(taken.what());
    path_ = taken.name;
    renamed_ = true;
  } catch (const std::exception& error) {
    failed_ = true;
    warn(fmt::format("no checkpoint at {:.6g} s: {}", simulation.time(), error.what()));
  }
  last_ = Clock::now();
}

CheckpointRobot checkpoint_robot_of(const RobotIdentity& identity, const std::string& failure) {
  return {.index = identity.index,
          .name = identity.name,
          .file = identity.file,
          .random = identity.random,
          .failure = failure};
}

RobotIdentity identity_of(const CheckpointRobot& robot) {
  return {
      .index = static_cast<std::size_t>(robot.index), .name = robot.name, .file = robot.file, .random = robot.random};
}

ResumedRun resumed_run(Checkpoint checkpoint, const std::filesystem::path& file, const Device& device) {
  Configuration configuration = checkpoint.configuration;
  configuration.device = device_for(checkpoint, device);
  Simulation simulation(configuration, checkpoint.robots);
  simulation.restore(checkpoint.state);
  if (backend_of(simulation) != checkpoint.backend)
    warn(fmt::format("{} is from {}; on this device, {}, the run goes on with other roundings", file.string(),
                     checkpoint.device_name, simulation.device_name()));
  ResumedRun run{.simulation = std::move(simulation), .identities = {}, .failed = {}, .progress = {}, .notes = {}};
  for (const CheckpointRobot& robot : checkpoint.notes.robots) run.identities.push_back(identity_of(robot));
  for (const CheckpointRobot& robot : checkpoint.notes.failed)
    run.failed.push_back({.identity = identity_of(robot), .failure = robot.failure});
  run.progress.sampled = checkpoint.notes.sampled;
  for (const TrialMeasures::Sums& sums : checkpoint.notes.measures)
    run.progress.measures.emplace_back(sums, run.simulation.configuration().environment);
  run.notes = std::move(checkpoint.notes);
  return run;
}

std::unique_ptr<TrajectoryReader> recording_before(const CheckpointRecording& recording) {
  std::string problem;
  for (const std::string& name : {recording.unfinished, recording.path}) {
    std::error_code error;
    if (name.empty() || !std::filesystem::exists(name, error)) continue;
    try {
      auto reader = std::make_unique<TrajectoryReader>(name, shown_work());
      if (reader->frames() >= static_cast<std::size_t>(recording.frames)) return reader;
      problem = fmt::format("{} has {} frames, the checkpoint {}", name, reader->frames(), recording.frames);
    } catch (const InputError& damaged) {
      problem = damaged.what();
    }
  }
  if (problem.empty()) problem = recording.unfinished + " is missing";
  throw InputError("--record", "the recording before the checkpoint cannot be continued: " + problem);
}

}  // namespace mercury
