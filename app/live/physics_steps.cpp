// SPDX-License-Identifier: Apache-2.0
// The steps of the physics thread, in slices: as many as are due, with samples of the telemetry between them.
#include <algorithm>
#include <cmath>

#include "app/live/physics_parts.h"

namespace mercury {
namespace {

constexpr double slice_seconds = 0.006;  // wall time between two looks at the commands
constexpr double long_slice_seconds = 0.1;

}  // namespace

void Physics::Parts::begin_pace() {
  pace.start(wall_now(), speed, simulation.configuration().dt);
  gauge.clear();
  gauge.mark(wall_now(), simulation.time());
}

// A GPU that also draws switches to the steps and back in about 2 ms, so they come once per picture: when the window
// wants a snapshot, else after this many.
std::int64_t Physics::Parts::steps_at_once() const {
  constexpr double launch_period = 0.05;  // wall time [s]
  if (cuda_device < 0 || !std::isfinite(speed)) return 1;
  return std::max<std::int64_t>(1, std::llround(launch_period * speed / simulation.configuration().dt));
}

// Makes one slice of the steps that are due.
void Physics::Parts::advance() {
  if (seek_target) return advance_seek();
  if (simulation.size() == 0) steps_left = 0;
  if (steps_left == 0 && !is_running()) return;
  if (recording) return advance_recording();
  if (loop_back()) return;
  const auto steps_in = [&](double seconds) {
    return step_seconds > 0 ? static_cast<std::int64_t>(std::clamp(seconds / step_seconds, 1.0, 1e6)) : 1;
  };
  // Several steps per call are faster for large batches, because the state stays in the cache.
  std::int64_t affordable = std::max(steps_in(slice_seconds), std::min(steps_in(long_slice_seconds), std::int64_t{16}));
  if (loop && playing)
    affordable = std::clamp(timeline.step_at(loop->second) - simulation.steps(), std::int64_t{1}, affordable);
  if (viewing) affordable = std::min(affordable, head_step - simulation.steps());
  if (affordable <= 0) return return_to_present();
  if (steps_left > 0) {
    const std::int64_t count = std::min(affordable, steps_left);
    take_steps(count);
    steps_left = std::max<std::int64_t>(0, steps_left - count);
    if (viewing && simulation.steps() == head_step) return_to_present();
    return;
  }
  const std::int64_t due = pace.due(wall_now());
  if (due < (is_watched ? 1 : steps_at_once())) return;
  const std::int64_t count = std::min(affordable, due);
  take_steps(count);
  pace.done(count);
  gauge.mark(wall_now(), simulation.time());
  if (viewing && simulation.steps() == head_step && !loop) return_to_present();
}

// Interrupts the steps where a sample of the telemetry is due and where a replay changes something.
void Physics::Parts::take_steps(std::int64_t count) {
  const std::int64_t target = simulation.steps() + count;
  double spent = 0;
  while (simulation.steps() < target) {
    viewing ? apply_events() : apply_repro_changes();
    const std::int64_t sample = std::max(next_sample(), simulation.steps() + 1);
    const std::int64_t stop = std::min({target, sample, viewing ? next_stop() : next_change_step(), next_beginning()});
    const double start = wall_now();
    simulation.step(stop - simulation.steps());
    advance_companions();
    const double stepped = wall_now();
    spent += stepped - start;
    if (stop != sample && stop != target) continue;
    telemetry = simulation.telemetry();
    if (!viewing || era == head_era) {
      measurements.observe(simulation.time(), simulation.steps(), telemetry);
      observe_companions();
    }
    if (!viewing) report_explosions(true);
    measuring_seconds += wall_now() - stepped;
    if (!playing && steps_left == 0 && !viewing) break;  // stopped by an explosion
  }
  stepping_seconds += spent;
  limit_measuring();
  if (!viewing) {
    work += spent;
    replay_log.stepped(spent, simulation, *population.robots());
    keep_due_keyframe();
  }
  const double each = spent / static_cast<double>(count);
  step_seconds = step_seconds > 0 ? 0.8 * step_seconds + 0.2 * each : each;
  dirty = true;
}

// At unlimited speed, samples must not take much of the time: makes them rarer.
void Physics::Parts::limit_measuring() {
  constexpr double most = 0.02, enough = 0.05;  // share of the time; [s] of steps before it is known
  if (stepping_seconds < enough) return;
  if (playing && !std::isfinite(speed) && measuring_seconds > most * stepping_seconds)
    for (Measurements* measured : {&measurements, &second_measurements, &ghost_measurements}) measured->thin_out();
  stepping_seconds = measuring_seconds = 0;
}

// `from_steps`: the robots exploded in the steps just made. Otherwise they came back exploded, and there is no repro.
void Physics::Parts::report_explosions(bool from_steps) {
  const LiveRobots& robots = *population.robots();
  for (std::size_t i = 0; i < robots.size(); ++i) {
    if (!telemetry[i].exploded || !exploded.insert(robots.robots[i].id).second) continue;
    std::function<Repro()> repro;
    if (from_steps) repro = replay_log.repro(simulation, robots, i, telemetry[i]);
    if (from_steps && stop_at_explosion) {
      playing = false;
      steps_left = 0;
      ++stops;
    }
    const std::lock_guard lock(mutex);
    if (repro) repros[robots.robots[i].id] = std::move(repro);
    explosions.push_back({robots.robots[i].id, telemetry[i].exploded_at, telemetry[i].culprit_spring});
  }
}

}  // namespace mercury
