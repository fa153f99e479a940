// SPDX-License-Identifier: Apache-2.0
#include "app/export/simulated_motion.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>

#include "app/recording/recorder.h"

namespace mercury {
namespace {

std::int64_t steps_per_frame(const Configuration& configuration) {
  return std::max<std::int64_t>(1, std::llround(1 / (motion_rate * configuration.dt)));
}

}  // namespace

TemporaryRecording::TemporaryRecording(const std::filesystem::path& beside)
    : path_(beside.parent_path() / fmt::format(".{}.{}.h5", beside.filename().string(), getpid())) {}

TemporaryRecording::~TemporaryRecording() {
  std::error_code ignored;
  std::filesystem::remove(path_, ignored);
}

std::int64_t record_motion(Simulation& simulation, double seconds, const std::filesystem::path& path,
                           std::optional<std::uint64_t> seed, const std::function<void(std::int64_t)>& watch) {
  const std::int64_t last = simulation.steps() + std::llround(seconds / simulation.configuration().dt);
  Recorder recorder(simulation, path,
                    {.every = steps_per_frame(simulation.configuration()), .last_step = last, .seed = seed});
  while (simulation.steps() < last) {
    simulation.step(std::min(last, recorder.next_step()) - simulation.steps());
    recorder.observe();
    watch(recorder.frames());
  }
  recorder.finish();
  return recorder.frames();
}

std::int64_t motion_frames(const Configuration& configuration, double seconds) {
  return std::llround(seconds / configuration.dt) / steps_per_frame(configuration) + 1;
}

}  // namespace mercury
