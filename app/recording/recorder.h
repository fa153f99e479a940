// SPDX-License-Identifier: Apache-2.0
// Records a simulation while it runs, one frame every few steps.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>

#include "app/recording/trajectory_reader.h"
#include "app/recording/trajectory_writer.h"
#include "mercury/simulation.h"

namespace mercury {

struct RecordingOptions {
  std::int64_t every = 1;                             // steps per frame
  std::optional<std::int64_t> first_step, last_step;  // where the recording begins and ends, if known
  std::optional<std::uint64_t> seed;                  // of the random robots, if any
  int deflate = 0;                                    // compression: 0 = none, 1 (fast) .. 9
};

// The beginning of a recording that is to be continued.
struct RecordingStart {
  TrajectoryReader& recording;
  std::int64_t frames = 0;  // its first ones, at least 1
};

class Recorder {
 public:
  // Takes the first frame now. Throws like TrajectoryWriter; its messages name the option --record.
  Recorder(const Simulation& simulation, const std::filesystem::path& path, const RecordingOptions& options);

  // Copies the frames of the start instead, and goes on after them, as the simulation does. Throws InputError if they
  // are not frames of this simulation, up to its current step.
  Recorder(const Simulation& simulation, const std::filesystem::path& path, const RecordingOptions& options,
           const RecordingStart& start);

  // The step at which the next frame is due.
  std::int64_t next_step() const { return next_; }
  // Takes a frame if one is due. Call it when the simulation is at next_step(). Throws like TrajectoryWriter; after a
  // RecordingFailure only failed() and frames() may be called.
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
  void set_next(std::int64_t last_frame);

  const Simulation& simulation_;
  std::int64_t every_, next_;
  TrajectoryWriter writer_;
};

}  // namespace mercury
