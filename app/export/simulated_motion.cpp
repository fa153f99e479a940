// SPDX-License-Identifier: Apache-2.0
#include "app/export/simulated_motion.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>

#include "app/recording/recorder.h"

namespace mercury {

TemporaryRecording::TemporaryRecording(const std::filesystem::path& beside)
    : path_(beside.parent_path() / fmt::format(".{}.{}.h5", beside.filename().string(), getpid())) {}

TemporaryRecording::~TemporaryRecording() {
  std::error_code ignored;
  std::filesystem::remove(path_, ignored);
}

SimulatedMotion record_motion(Simulation& simulation, double seconds, const std::filesystem::path& path,
                              std::optional<std::uint64_t> seed, const std::function<void(std::int64_t)>& watch,
                              double rate) {
  const std::int64_t last = simulation.steps() + std::llround(seconds / simulation.configuration().dt);
  Recorder recorder(simulation, path,
                    {.rate = rate, .last_step = last, .seed = seed, .brains = simulation.has_brains()}, "-o");
  watch(recorder.frames());
  while (simulation.steps() < last) {
    simulation.step(std::min(recorder.next_step(), last) - simulation.steps());
    recorder.observe();
    watch(recorder.frames());
  }
  SimulatedMotion motion{.frames = recorder.frames(), .final_states = {}};
  for (std::size_t robot = 0; robot < simulation.size(); ++robot)
    motion.final_states.push_back(fmt::format("{:016x} at {:.6g} s", simulation.hash(robot), simulation.time()));
  recorder.finish();
  return motion;
}

std::int64_t motion_frames(double seconds, double rate) {
  return static_cast<std::int64_t>(std::floor(seconds * rate + 1e-6)) + 1;
}

}  // namespace mercury
