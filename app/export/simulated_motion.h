// SPDX-License-Identifier: Apache-2.0
// The motion of robots that is simulated for an export: it goes through a recording, as every motion does.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "mercury/simulation.h"

namespace mercury {

// A recording that lives as long as the export from it.
class TemporaryRecording {
 public:
  // Beside the file that is exported: there is room for both, or for neither.
  explicit TemporaryRecording(const std::filesystem::path& beside);
  ~TemporaryRecording();
  TemporaryRecording(const TemporaryRecording&) = delete;
  TemporaryRecording& operator=(const TemporaryRecording&) = delete;
  const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_;
};

inline constexpr double motion_rate = 30;  // frames per second of simulated time, unless another one is wanted

struct SimulatedMotion {
  std::int64_t frames = 0;
  std::vector<std::string> final_states;  // of each robot after all steps: its hash, and when
};

// Steps the simulation for that time and records it at exactly `rate` frames per second: a frame between two steps is
// interpolated between them. `watch` sees how many frames there are; it may throw to stop the work.
SimulatedMotion record_motion(Simulation& simulation, double seconds, const std::filesystem::path& path,
                              std::optional<std::uint64_t> seed, const std::function<void(std::int64_t)>& watch,
                              double rate = motion_rate);
// Frames that it will have.
std::int64_t motion_frames(double seconds, double rate = motion_rate);

}  // namespace mercury
