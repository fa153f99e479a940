// SPDX-License-Identifier: Apache-2.0
#include "app/recording/recorder.h"

#include <algorithm>

#include "app/base/progress.h"
#include "mercury/error.h"

namespace mercury {
namespace {

std::vector<const Robot*> robots_of(const Simulation& simulation) {
  std::vector<const Robot*> robots;
  for (std::size_t i = 0; i < simulation.size(); ++i) robots.push_back(&simulation.robot(i));
  return robots;
}

bool records_brains(const Simulation& simulation, const RecordingOptions& options) {
  if (options.brains && !simulation.has_brains()) throw ParameterError("brains", "none of the robots has a brain");
  return options.brains;
}

FramePlaces places_of(const Simulation& simulation, const RecordingOptions& options, std::int64_t first) {
  return options.rate ? FramePlaces(first, *options.rate, simulation.configuration().dt)
                      : FramePlaces(first, options.every);
}

TrajectoryHeader header_of(const Simulation& simulation, const RecordingOptions& options) {
  const std::int64_t first = options.first_step.value_or(simulation.steps());
  const FramePlaces places = places_of(simulation, options, first);
  return {.configuration = simulation.configuration(),
          .device_name = simulation.device_name(),
          .seed = options.seed,
          .every = places.every(),
          .frame_rate = options.rate,
          .expected_frames = options.last_step ? places.count(*options.last_step - first) : 0,
          .time = simulation.clock(),
          .brains = records_brains(simulation, options),
          .deflate = options.deflate,
          .watch = shown_work()};
}

}  // namespace

Recorder::Recorder(const Simulation& simulation, const std::filesystem::path& path, const RecordingOptions& options,
                   const char* option)
    : simulation_(simulation), places_(places_of(simulation, options, simulation.steps())), next_(simulation.steps()),
      start_time_(simulation.time()), rate_(options.rate),
      writer_(path, header_of(simulation, options), robots_of(simulation), simulation.materials(), option) {
  take();
}

Recorder::Recorder(const Simulation& simulation, const std::filesystem::path& path, const RecordingOptions& options,
                   const RecordingStart& start)
    : simulation_(simulation), places_(places_of(simulation, options, simulation.steps())), next_(simulation.steps()),
      start_time_(simulation.time()), rate_(options.rate),
      writer_(path, header_of(simulation, options), robots_of(simulation), simulation.materials(), "--record") {
  TrajectoryReader& before = start.recording;
  const auto frames = static_cast<std::size_t>(start.frames);
  if (frames < 1 || before.frames() < frames || before.every() != places_.every() || before.frame_rate() != rate_ ||
      before.mass_count() != simulation.mass_count() || before.has_brains() != options.brains ||
      before.robots().size() != simulation.size() || before.step(frames - 1) > simulation.steps())
    throw InputError(before.path().string(), "is not the beginning of this recording");
  for (std::size_t i = 0; i < frames; ++i) {
    const TrajectoryWriter::Frame frame = writer_.add(before.step(i), before.time(i));
    std::ranges::copy(before.positions(i), frame.positions.begin());
    std::ranges::copy(before.velocities(i), frame.velocities.begin());
    std::ranges::copy(before.senses(i), frame.senses.begin());
    std::ranges::copy(before.neurons(i), frame.neurons.begin());
    writer_.commit();
  }
  places_ = places_of(simulation, options, before.step(0));
  start_time_ = before.time(0);
  set_next();
}

void Recorder::observe() {
  const FramePlace place = places_.of(writer_.frames());
  if (simulation_.steps() < next_) return;
  if (place.is_between_steps() && !before_ && simulation_.steps() == place.step) return hold();
  take();
}

// A frame between two steps: the first of them.
void Recorder::hold() {
  before_.emplace();
  before_->positions.resize(simulation_.mass_count());
  before_->velocities.resize(simulation_.mass_count());
  simulation_.read_positions(before_->positions);
  simulation_.read_velocities(before_->velocities);
  next_ = simulation_.steps() + 1;
}

void Recorder::take() {
  const std::int64_t number = writer_.frames();
  const FramePlace place = places_.of(number);
  const TrajectoryWriter::Frame frame =
      rate_ ? writer_.add(place.step, start_time_ + static_cast<double>(number) / *rate_)
            : writer_.add(simulation_.steps(), simulation_.time());
  simulation_.read_positions(frame.positions);
  simulation_.read_velocities(frame.velocities);
  if (!frame.senses.empty() || !frame.neurons.empty()) simulation_.read_brains(frame.senses, frame.neurons);
  if (before_) {
    const auto mix = [&](std::vector<Vec3>& earlier, std::span<Vec3> now) {
      interpolate(earlier, now, place.share);
      std::ranges::copy(earlier, now.begin());
    };
    mix(before_->positions, frame.positions);
    mix(before_->velocities, frame.velocities);
    before_.reset();
  }
  writer_.commit();
  set_next();
}

// The later step of one frame may be the earlier one of the next.
void Recorder::set_next() {
  const FramePlace place = places_.of(writer_.frames());
  next_ = place.step;
  if (place.is_between_steps() && simulation_.steps() == place.step) hold();
}

void Recorder::finish() { writer_.finish(simulation_.telemetry()); }

void Recorder::finish_without_device() { writer_.finish({}); }

}  // namespace mercury
