// SPDX-License-Identifier: Apache-2.0
#include "app/recording/recorder.h"

#include <algorithm>
#include <limits>

#include "app/base/progress.h"
#include "mercury/error.h"

namespace mercury {
namespace {

std::vector<const Robot*> robots_of(const Simulation& simulation) {
  std::vector<const Robot*> robots;
  for (std::size_t i = 0; i < simulation.size(); ++i) robots.push_back(&simulation.robot(i));
  return robots;
}

TrajectoryHeader header_of(const Simulation& simulation, const RecordingOptions& options) {
  const std::int64_t steps = options.last_step.value_or(0) - options.first_step.value_or(simulation.steps());
  return {.configuration = simulation.configuration(),
          .device_name = simulation.device_name(),
          .seed = options.seed,
          .every = options.every,
          .expected_frames = options.last_step ? steps / options.every + 1 : 0,
          .time = simulation.clock(),
          .deflate = options.deflate,
          .watch = shown_work()};
}

}  // namespace

Recorder::Recorder(const Simulation& simulation, const std::filesystem::path& path, const RecordingOptions& options)
    : simulation_(simulation), every_(options.every), next_(simulation.steps()),
      writer_(path, header_of(simulation, options), robots_of(simulation), simulation.materials(), "--record") {
  take();
}

Recorder::Recorder(const Simulation& simulation, const std::filesystem::path& path, const RecordingOptions& options,
                   const RecordingStart& start)
    : simulation_(simulation), every_(options.every), next_(simulation.steps()),
      writer_(path, header_of(simulation, options), robots_of(simulation), simulation.materials(), "--record") {
  TrajectoryReader& before = start.recording;
  const auto frames = static_cast<std::size_t>(start.frames);
  if (frames < 1 || before.frames() < frames || before.every() != every_ ||
      before.mass_count() != simulation.mass_count() || before.robots().size() != simulation.size() ||
      before.step(frames - 1) > simulation.steps())
    throw InputError(before.path().string(), "is not the beginning of this recording");
  for (std::size_t i = 0; i < frames; ++i) {
    const TrajectoryWriter::Frame frame = writer_.add(before.step(i), before.time(i));
    std::ranges::copy(before.positions(i), frame.positions.begin());
    std::ranges::copy(before.velocities(i), frame.velocities.begin());
    writer_.commit();
  }
  set_next(before.step(frames - 1));
}

void Recorder::observe() {
  if (simulation_.steps() >= next_) take();
}

void Recorder::take() {
  const TrajectoryWriter::Frame frame = writer_.add(simulation_.steps(), simulation_.time());
  simulation_.read_positions(frame.positions);
  simulation_.read_velocities(frame.velocities);
  writer_.commit();
  set_next(simulation_.steps());
}

void Recorder::set_next(std::int64_t last_frame) {
  next_ = last_frame + std::min(every_, std::numeric_limits<std::int64_t>::max() - last_frame);
}

void Recorder::finish() { writer_.finish(simulation_.telemetry()); }

void Recorder::finish_without_device() { writer_.finish({}); }

}  // namespace mercury
