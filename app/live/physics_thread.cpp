// SPDX-License-Identifier: Apache-2.0
// The loop of the physics thread: take commands, carry them out, step, publish a snapshot.
#include <algorithm>
#include <cmath>
#include <exception>

#include "app/live/physics_parts.h"
#include "mercury/error.h"
#include "mercury/observables.h"

namespace mercury {

void Physics::Parts::run() {
  begin_pace();
  PendingCommands taken;
  while (wait_for_commands(taken)) {
    guarded([&] { carry_out(taken); });
    guarded([&] { advance(); });
    bool wanted;
    {
      const std::lock_guard lock(mutex);
      wanted = snapshot_wanted || ticket > tickets_done;
    }
    if (!dirty || !wanted || !may_publish()) continue;
    dirty = false;  // also if publishing fails, so that the failure is not repeated
    guarded([&] { publish_snapshot(); });
  }
}

// Waits for commands or for the time of the next step; on a GPU that the window watches, for that of its next picture.
// Returns false when the thread must end.
bool Physics::Parts::wait_for_commands(PendingCommands& taken) {
  std::unique_lock lock(mutex);
  const bool runs_on_device = cuda_device >= 0 && is_running() && std::isfinite(speed), was_wanted = snapshot_wanted;
  const double next_due = pace.next_due(was_wanted ? 1 : steps_at_once());
  const auto due =
      std::chrono::steady_clock::time_point(std::chrono::duration_cast<std::chrono::steady_clock::duration>(
          std::chrono::duration<double>(playing && std::isfinite(speed) ? std::min(next_due, wall_now() + 1) : 0)));
  const auto ready = [&] {
    return pending.any() || (dirty && (snapshot_wanted || ticket > tickets_done)) ||
           (runs_on_device && snapshot_wanted && !was_wanted);
  };
  if (steps_left == 0 && !seek_target && !ready()) {
    tickets_done = ticket;
    done.notify_all();
    if (is_running())
      wake.wait_until(lock, due, ready);
    else
      wake.wait(lock, ready);
  }
  is_watched = snapshot_wanted;
  taken = std::exchange(pending, {});
  ticket = std::max(ticket, taken.ticket);
  return !taken.quit;
}

// A failure of physics must not end the window: reports the error, pauses, and returns false.
bool Physics::Parts::guarded(auto task) {
  try {
    task();
    return true;
  } catch (const std::exception& error) {
    messages.add(Severity::error, error.what());
    playing = false;
    steps_left = 0;
    seek_target.reset();
    ++stops;
  }
  return false;
}

void Physics::Parts::carry_out(PendingCommands& taken) {
  if (!taken.any()) return;
  dirty = true;
  if (taken.pause_on_explosion) stop_at_explosion = *taken.pause_on_explosion;
  prepare_changes(taken);
  const bool dt_changed = taken.scene && taken.scene->configuration.dt != simulation.configuration().dt;
  bool robots_changed = false;
  const bool scene_changed = taken.scene.has_value();
  if (taken.scene && !guarded([&] { robots_changed = set_scene(*taken.scene); })) {
    // The scene is empty now, and paused. What was taken with it holds for the next one.
    robots_changed = true;
    taken.scene.reset();
    taken.playing.reset();
  }
  if (taken.view) view = *taken.view;
  if (taken.view || robots_changed) observe_details();
  take_comparison(taken);
  if (taken.scene && taken.scene->recording)
    begin_recording(taken.scene->recording);
  else if (recording && taken.reset)
    show_recording(recording->time(0));
  else if (taken.reset || (taken.scene && replayed_repro))
    restart();
  if (taken.perturbations) perturbations = std::move(*taken.perturbations);
  if (taken.perturbations || scene_changed) simulation.set_perturbations(population.perturbations_of(perturbations));
  if (taken.perturbations || scene_changed) follow_companions();
  begin_companions();
  if ((taken.perturbations || scene_changed || taken.reset) && !viewing) follow_changes(robots_changed);
  if (taken.bridge) bridge = std::move(*taken.bridge);
  if (robots_changed) step_seconds = 0;
  if (taken.speed) speed = *taken.speed;
  if (taken.playing) playing = *taken.playing;
  if (taken.drop_steps) steps_left = 0;
  carry_out_seek(taken);
  steps_left += taken.steps;
  if (taken.playing || taken.speed || taken.reset || taken.seek || robots_changed || dt_changed) begin_pace();
}

// Returns all robots to rest at time 0, or a replay to its start.
void Physics::Parts::restart() {
  simulation.reset();
  step_seconds = 0;  // exploded robots cost nothing until now
  population.forget_departed();
  exploded.clear();
  steps_left = 0;
  ++resets;
  replay_log.restart();
  {
    const std::lock_guard lock(mutex);
    repros.clear();
  }
  if (replayed_repro) begin_replay();
  restart_timeline();
  telemetry = simulation.telemetry();
  const double time = simulation.time();
  measurements.restart(*population.robots(), time, simulation.steps(), simulation.configuration(), telemetry);
  measurements.observe(time, simulation.steps(), telemetry);
  restart_companions();
}

// Returns whether the list of robots or the kind of environment changed.
bool Physics::Parts::set_scene(const PendingCommands::Scene& scene) {
  const auto& [robots, configuration, repro, recorded, next_surroundings] = scene;
  replayed_repro = repro;
  const bool first = simulation.size() == 0 && simulation.steps() == 0;
  const bool dt_changed = configuration.dt != simulation.configuration().dt;
  const Environment& before = simulation.configuration().environment;
  const bool moved = !same_parts(before, configuration.environment);
  const bool to_land = has_ground(configuration.environment) && !has_ground(before);
  if (next_surroundings != surroundings) population.keep_surroundings(surroundings);
  if (configuration != simulation.configuration()) simulation.configure(configuration);
  simulation.set_perturbations({});
  bool changed = false;
  try {
    changed = population.follow(robots);
  } catch (...) {
    start_over();
    throw;
  }
  if (next_surroundings != surroundings) enter_surroundings(next_surroundings, to_land);
  telemetry = simulation.telemetry();
  if (first || (dt_changed && simulation.steps() == 0))
    measurements.restart(*population.robots(), simulation.time(), simulation.steps(), configuration, telemetry);
  else
    measurements.set_robots(*population.robots(), simulation.time(), configuration.environment, telemetry);
  if (first) measurements.observe(simulation.time(), simulation.steps(), telemetry);
  if (!changed) return moved;
  std::erase_if(exploded, [&](RobotId id) { return !population.robots()->index_of(id); });
  report_explosions(false);
  for (const std::string& note : simulation.notes())
    if (reported_notes.insert(note).second) messages.add(Severity::note, note);
  return true;
}

// Gives robots the states that they had in these surroundings, or sets them down.
void Physics::Parts::enter_surroundings(std::uint64_t next, bool to_land) {
  surroundings = next;
  if (!population.restore_surroundings(next) && to_land) population.settle();
  replay_log.forget_states();  // the steps before do not lead to these
  step_seconds = 0;
  const std::vector<Telemetry> now = simulation.telemetry();
  const auto is_whole = [&](RobotId id) {
    const auto index = population.robots()->index_of(id);
    return !index || !now[*index].exploded;
  };
  std::erase_if(exploded, is_whole);
  const std::lock_guard lock(mutex);
  std::erase_if(repros, [&](const auto& one) { return is_whole(one.first); });
}

// If a simulation cannot take its robots, for example for lack of memory, it is left half changed. Replaces it by an
// empty one.
void Physics::Parts::start_over() {
  details.reset();
  second.reset();
  ghosts.reset();
  simulation = Simulation(simulation.configuration());
  population.start_over();
  telemetry.clear();
  exploded.clear();
  replay_log.restart();
  replayed_repro.reset();
  recording.reset();
  restart_timeline();
  ++resets;
  measurements.restart(*population.robots(), 0, 0, simulation.configuration(), telemetry);
}

// Observes the details of the view that exist in this environment.
void Physics::Parts::observe_details() {
  details.reset();
  details.emplace(simulation, known_in(view, simulation.configuration().environment));
}

// At unlimited speed, snapshots may take at most a twentieth of the time.
bool Physics::Parts::may_publish() const {
  constexpr double share = 0.05;
  if (!playing || std::isfinite(speed) || ticket > tickets_done) return true;
  return wall_now() - published_at >= (1 / share - 1) * gathering_seconds;
}

void Physics::Parts::take_positions(SnapshotPositions& positions) {
  const std::size_t masses = simulation.mass_count();
  try {
    if (bridge && masses > 0) return positions.set_on_device(bridge->take(simulation), masses);
  } catch (const DeviceError& error) {
    messages.add(Severity::note, std::string("positions are copied through the host: ") + error.what());
    bridge.reset();
  }
  simulation.read_positions(positions.set_on_host(masses));
}

void Physics::Parts::publish_snapshot() {
  const double start = wall_now();
  std::shared_ptr<Snapshot> next = pool.take();
  next->robots = population.robots();
  next->configuration = simulation.configuration();
  next->time = simulation.time();
  next->steps = simulation.steps();
  next->resets = resets;
  next->stops = stops;
  next->failed_seconds = failed_seconds;
  next->failed_ghosts = failed_ghosts;
  // On a GPU, velocities are a copy, and the steps wait for it.
  const bool with_velocities = !playing || velocities_wanted || ticket > tickets_done;
  next->velocities.resize(with_velocities ? simulation.mass_count() : 0);
  take_positions(next->positions);
  if (with_velocities) simulation.read_velocities(next->velocities);
  next->telemetry = telemetry;
  next->details = details ? details->observe(telemetry) : SceneDetails{};
  next->color = details ? &details->color() : &material_color();
  next->perturbations.clear();
  for (const LivePerturbation& perturbation : perturbations)
    if (!population.perturbations_of({&perturbation, 1}).empty()) next->perturbations.push_back(perturbation);
  next->timeline = timeline_state();
  next->playing = playing;
  next->speed = speed;
  next->due_at = playing && std::isfinite(speed) ? pace.done_at() : 0;
  next->achieved_speed = playing ? gauge.speed() : 0;
  next->step_seconds = step_seconds;
  publish_companions(*next, with_velocities);
  next->springs_per_second = step_seconds > 0 && (playing || steps_left > 0)
                                 ? static_cast<double>(population.robots()->springs) / step_seconds
                                 : 0;
  published_at = wall_now();
  next->gathering_seconds = gathering_seconds = published_at - start;
  const std::lock_guard lock(mutex);
  snapshot = std::move(next);
  snapshot_wanted = false;
}

}  // namespace mercury
