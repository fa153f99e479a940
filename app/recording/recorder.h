// SPDX-License-Identifier: Apache-2.0
// Records a simulation while it runs: a frame every few steps, or a number of them per second. Senses and neurons are
// those of the last thought; of a frame between two steps, those with which the later one was made.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>

#include "app/base/frame_places.h"
#include "app/recording/trajectory_reader.h"
#include "app/recording/trajectory_writer.h"
#include "mercury/simulation.h"
#include "mercury/state.h"

namespace mercury {

struct RecordingOptions {
  std::int64_t every = 1;                             // steps per frame
  std::optional<double> rate;                         // instead: frames per second, at most one per step
  std::optional<std::int64_t> first_step, last_step;  // where the recording begins and ends, if known
  std::optional<std::uint64_t> seed;                  // of the random robots, if any
  bool brains = false;                                // frames have senses and neurons, too
  int deflate = 0;                                    // compression: 0 = none, 1 (fast) .. 9
};

// The beginning of a recording that is to be continued.
struct RecordingStart {
  TrajectoryReader& recording;
  std::int64_t frames = 0;  // its first ones, at least 1
};

class Recorder {
 public:
  // Takes the first frame now. Throws like TrajectoryWriter; its messages name the option. Throws
  // ParameterError("brains", ...) if the options ask for brains and no robot has one.
  Recorder(const Simulation& simulation, const std::filesystem::path& path, const RecordingOptions& options,
           const char* option = "--record");

  // Copies the frames of the start instead, and goes on after them, as the simulation does. Throws InputError if they
  // are not frames of this simulation, up to its current step.
  Recorder(const Simulation& simulation, const std::filesystem::path& path, const RecordingOptions& options,
           const RecordingStart& start);

  // The next step that a frame needs. One between two steps needs both.
  std::int64_t next_step() const { return next_; }
  // Takes a frame, or its first half, if one is due. Call it when the simulation is at next_step(). Throws like
  // TrajectoryWriter; after a RecordingFailure only failed() and frames() may be called.
  void observe();
  // Writes all frames so far, so that they survive the program. Throws like TrajectoryWriter.
  void flush() { writer_.flush(); }
  const std::filesystem::path& unfinished_path() const { return writer_.unfinished_path(); }
  // Completes the file and gives it its name.
  void finish();
  // The same when the device has failed: with the frames so far, and without which robots exploded.
  void finish_without_device();

  std::int64_t frames() const { return writer_.frames(); }
  // Whether a frame could not be written.
  bool failed() const { return writer_.failed(); }

 private:
  void take();
  void hold();
  void set_next();

  const Simulation& simulation_;
  FramePlaces places_;
  std::int64_t next_;
  double start_time_;  // [s]
  std::optional<double> rate_;
  std::optional<BatchState> before_;  // the step before the next frame, once it was there
  TrajectoryWriter writer_;
};

}  // namespace mercury
