// SPDX-License-Identifier: Apache-2.0
// Records a simulation while it runs, one frame every few steps.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>

#include "app/recording/trajectory_writer.h"
#include "mercury/simulation.h"

namespace mercury {

struct RecordingOptions {
  std::int64_t every = 1;                 // steps per frame
  std::optional<std::int64_t> last_step;  // where the recording ends, if known
  std::optional<std::uint64_t> seed;      // of the random robots, if any
  int deflate = 0;                        // compression: 0 = none, 1 (fast) .. 9
};

class Recorder {
 public:
  // Takes the first frame now. Throws like TrajectoryWriter; its messages name the option --record.
  Recorder(const Simulation& simulation, const std::filesystem::path& path, const RecordingOptions& options);

  // The step at which the next frame is due.
  std::int64_t next_step() const { return next_; }
  // Takes a frame if one is due. Call it when the simulation is at next_step(). Throws like TrajectoryWriter.
  void observe();
  // Completes the file and gives it its name.
  void finish();
  // The same when the device has failed: with the frames so far, and without which robots exploded.
  void finish_without_device();

  std::int64_t frames() const { return writer_.frames(); }

 private:
  void take();

  const Simulation& simulation_;
  std::int64_t every_, next_;
  TrajectoryWriter writer_;
};

}  // namespace mercury
