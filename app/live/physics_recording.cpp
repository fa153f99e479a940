// SPDX-License-Identifier: Apache-2.0
// Plays a recording on the physics thread: shows its frames, and goes on simulating from one.
//
// The simulation holds the recorded robots and is put into the state of each moment, so that colors, arrows and
// measures work as for live robots. Between two frames positions are interpolated; the steps between them are not
// computed again, since the recording may come from a much faster machine.
#include <algorithm>
#include <cmath>

#include "app/live/physics_parts.h"

namespace mercury {
namespace {

void mix(std::vector<Vec3>& now, std::span<const Vec3> next, float share) {
  for (std::size_t i = 0; i < now.size(); ++i) now[i] += share * (next[i] - now[i]);
}

}  // namespace

void Physics::Parts::begin_recording(std::shared_ptr<TrajectoryReader> reader) {
  recording = std::move(reader);
  perturbations.clear();
  steps_left = 0;
  exploded.clear();
  replay_log.restart();
  clear_timeline();
  viewing = true;
  show_recording(recording->time(0));
  measurements.restart(*population.robots(), simulation.time(), simulation.steps(), simulation.configuration(),
                       telemetry);
  measurements.observe(simulation.time(), simulation.steps(), telemetry);
}

void Physics::Parts::show_recording(double time) {
  TrajectoryReader& reader = *recording;
  time = std::clamp(time, reader.time(0), reader.time(reader.frames() - 1));
  const std::size_t frame = reader.frame_at(time);
  BatchState state = reader.state(frame);
  if (frame + 1 < reader.frames() && time > reader.time(frame)) {
    const double share = (time - reader.time(frame)) / (reader.time(frame + 1) - reader.time(frame));
    mix(state.positions, reader.positions(frame + 1), static_cast<float>(share));
    mix(state.velocities, reader.velocities(frame + 1), static_cast<float>(share));
    state.clock.step += std::llround(share * static_cast<double>(reader.step(frame + 1) - reader.step(frame)));
  }
  if (time < recording_time) ++resets;
  simulation.restore(state);
  recording_time = time;
  telemetry = simulation.telemetry();
  measurements.observe(simulation.time(), simulation.steps(), telemetry);
  report_explosions(false);
  dirty = true;
}

void Physics::Parts::advance_recording() {
  const TrajectoryReader& reader = *recording;
  const std::size_t last = reader.frames() - 1, next = std::min(last, reader.frame_at(recording_time) + 1);
  if (steps_left > 0) {
    steps_left = 0;
    return show_recording(reader.time(next));
  }
  double time = reader.time(next);
  if (std::isfinite(speed)) {
    const std::int64_t due = pace.due(wall_now());
    if (due <= 0) return;
    pace.done(due);
    time = recording_time + static_cast<double>(due) * simulation.configuration().dt;
  }
  const double end = loop ? std::min(loop->second, reader.time(last)) : reader.time(last);
  if (time >= end && loop) {
    time = loop->first;
  } else if (recording_time >= reader.time(last)) {
    playing = false;
    ++stops;
  }
  show_recording(time);
  gauge.mark(wall_now(), recording_time);
}

// Simulates from the frame at or before the moment that is shown.
void Physics::Parts::leave_recording() {
  simulation.restore(recording->state(recording->frame_at(recording_time)));
  recording.reset();
  viewing = false;
  telemetry = simulation.telemetry();
  ++resets;
  std::erase_if(exploded, [&](RobotId id) {
    const auto index = population.robots()->index_of(id);
    return !index || !telemetry[*index].exploded;
  });
  measurements.cut(simulation.time(), simulation.steps());
  replay_log.restart();
  replay_log.follow(simulation, *population.robots(), perturbations);
  restart_timeline();
  begin_pace();
  dirty = true;
}

}  // namespace mercury
