// SPDX-License-Identifier: Apache-2.0
// Records a simulation while it runs: every so many steps a frame.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>

#include "app/recording/trajectory_writer.h"
#include "mercury/simulation.h"

namespace mercury {

struct RecordingOptions {
  std::int64_t every = 1;                 // steps from frame to frame
  std::optional<std::int64_t> last_step;  // when the recording will end, if that is known
  std::optional<std::uint64_t> seed;      // of the robots made at random, if there are any
  int deflate = 0;                        // compression: 0 = none, 1 (fast) .. 9
};

class Recorder {
 public:
  // Takes the first frame now. Throws as TrajectoryWriter, naming the option --record.
  Recorder(const Simulation& simulation, const std::filesystem::path& path, const RecordingOptions& options);

  // The step at which the next frame is due.
  std::int64_t next_step() const { return next_; }
  // Takes a frame if one is due; to be called when the simulation stands at next_step(). Throws as TrajectoryWriter.
  void observe();
  // Ends the file and gives it its name.
  void finish();

  std::int64_t frames() const { return writer_.frames(); }

 private:
  void take();

  const Simulation& simulation_;
  std::int64_t every_, next_;
  TrajectoryWriter writer_;
};

}  // namespace mercury
