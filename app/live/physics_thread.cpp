// SPDX-License-Identifier: Apache-2.0
// The physics thread: what is asked for is taken, carried out, and what came of it told.
#include <algorithm>
#include <cmath>
#include <exception>

#include "app/live/physics_parts.h"
#include "mercury/observables.h"

namespace mercury {

void Physics::Parts::run() {
  begin_pace();
  PendingCommands taken;
  while (take_pending(taken)) {
    guarded([&] { carry_out(taken); });
    guarded([&] { advance(); });
    bool wanted;
    {
      const std::lock_guard lock(mutex);
      wanted = looked_at || ticket > tickets_done;
    }
    if (!dirty || !wanted || !may_tell()) continue;
    dirty = false;  // also when it fails: not again before something else changes
    guarded([&] { tell(); });
  }
}

// Waits for pending, or for the next step's time. False when it is time to go.
bool Physics::Parts::take_pending(PendingCommands& taken) {
  const auto due = std::chrono::steady_clock::time_point(
      std::chrono::duration_cast<std::chrono::steady_clock::duration>(std::chrono::duration<double>(
          playing && std::isfinite(speed) ? std::min(pace.next_due(), wall_now() + 1) : 0)));
  std::unique_lock lock(mutex);
  const auto ready = [&] { return pending.any() || (dirty && (looked_at || ticket > tickets_done)); };
  if (steps_left == 0 && !ready()) {
    tickets_done = ticket;
    done.notify_all();
    if (playing)
      asked.wait_until(lock, due, ready);
    else
      asked.wait(lock, ready);
  }
  taken = std::exchange(pending, {});
  ticket = std::max(ticket, taken.ticket);
  return !taken.quit;
}

// The window must not end because physics failed: it is told, and physics rests.
void Physics::Parts::guarded(auto work) {
  try {
    work();
  } catch (const std::exception& error) {
    messages.add(Severity::error, error.what());
    playing = false;
    steps_left = 0;
    ++stops;
  }
}

void Physics::Parts::carry_out(PendingCommands& taken) {
  if (!taken.any()) return;
  dirty = true;
  if (taken.pause_on_explosion) stop_at_explosion = *taken.pause_on_explosion;
  const bool other_dt = taken.scene && taken.scene->configuration.dt != simulation.configuration().dt;
  const bool others = taken.scene && set_scene(*taken.scene);
  if (taken.view) view = *taken.view;
  if (taken.view || others) watch();
  if (taken.reset || (taken.scene && replayed)) begin_time();
  if (taken.perturbations) perturbations = std::move(*taken.perturbations);
  if (taken.perturbations || taken.scene) simulation.set_perturbations(population.perturbations_of(perturbations));
  if (taken.perturbations || taken.scene || taken.reset)
    replay_log.follow(simulation, *population.robots(), perturbations);
  if (taken.speed) speed = *taken.speed;
  if (taken.playing) playing = *taken.playing;
  if (taken.drop_steps) steps_left = 0;
  steps_left += taken.steps;
  if (taken.playing || taken.speed || taken.reset || others || other_dt) begin_pace();
}

// All from the start: at rest at time 0, or where what is made to happen again begins.
void Physics::Parts::begin_time() {
  simulation.reset();
  population.forget_departed();
  exploded.clear();
  steps_left = 0;
  ++resets;
  replay_log.restart();
  {
    const std::lock_guard lock(mutex);
    repros.clear();
  }
  if (replayed) begin_replay();
  telemetry = simulation.telemetry();
  const double time = simulation.time();
  measurements.restart(*population.robots(), time, simulation.steps(), simulation.configuration().dt, telemetry);
  measurements.observe(time, simulation.steps(), telemetry);
}

// Whether there are other robots now, or another kind of environment.
bool Physics::Parts::set_scene(const PendingCommands::Scene& scene) {
  const auto& [robots, configuration, repro] = scene;
  replayed = repro;
  const bool first = simulation.size() == 0 && simulation.steps() == 0;
  const bool other_dt = configuration.dt != simulation.configuration().dt;
  const bool moved = configuration.environment.index() != simulation.configuration().environment.index();
  simulation.configure(configuration);
  simulation.set_perturbations({});
  bool changed = false;
  try {
    changed = population.follow(robots);
  } catch (...) {
    start_over();
    throw;
  }
  telemetry = simulation.telemetry();
  if (first || (other_dt && simulation.steps() == 0))
    measurements.restart(*population.robots(), simulation.time(), simulation.steps(), configuration.dt, telemetry);
  else
    measurements.set_robots(*population.robots(), simulation.time(), telemetry);
  if (first) measurements.observe(simulation.time(), simulation.steps(), telemetry);
  if (!changed) return moved;
  std::erase_if(exploded, [&](RobotId id) { return !population.robots()->index_of(id); });
  note_explosions(false);  // of robots that came back as they were
  for (const std::string& note : simulation.notes())
    if (told_notes.insert(note).second) messages.add(Severity::note, note);
  return true;
}

// A simulation that could not take its robots, as for want of memory, is left half changed: an empty one takes its
// place.
void Physics::Parts::start_over() {
  details.reset();
  simulation = Simulation(simulation.configuration());
  population.start_over();
  telemetry.clear();
  exploded.clear();
  replay_log.restart();
  replayed.reset();
  ++resets;
  measurements.restart(*population.robots(), 0, 0, simulation.configuration().dt, telemetry);
}

// Details that this environment knows.
void Physics::Parts::watch() {
  details.reset();
  const Environment& environment = simulation.configuration().environment;
  ViewSettings known = view;
  if (!known.color->exists_in(environment)) known.color = &material_color();
  if (!has_face_forces(environment)) known.shown.arrows.drag = known.shown.arrows.lift = false;
  if (!std::holds_alternative<Land>(environment)) known.shown.arrows.contact = false;
  details.emplace(simulation, known);
}

// As fast as it goes, pictures may take a fifth of the time from the steps, and no more.
bool Physics::Parts::may_tell() const {
  constexpr double share = 0.2;
  if (!playing || std::isfinite(speed) || ticket > tickets_done) return true;
  return wall_now() - told_at >= (1 / share - 1) * gathering_seconds;
}

void Physics::Parts::tell() {
  const double start = wall_now();
  std::shared_ptr<Snapshot> next = pool.take();
  next->robots = population.robots();
  next->configuration = simulation.configuration();
  next->time = simulation.time();
  next->steps = simulation.steps();
  next->resets = resets;
  next->stops = stops;
  next->positions.resize(simulation.mass_count());
  // On a card, each of the two is a copy that the steps wait for.
  const bool with_velocities = !playing || velocities_wanted || ticket > tickets_done;
  next->velocities.resize(with_velocities ? simulation.mass_count() : 0);
  simulation.read_positions(next->positions);
  if (with_velocities) simulation.read_velocities(next->velocities);
  next->telemetry = telemetry;
  next->details = details ? details->observe(telemetry) : SceneDetails{};
  next->color = details ? &details->color() : &material_color();
  next->perturbations.clear();
  for (const LivePerturbation& perturbation : perturbations)
    if (!population.perturbations_of({&perturbation, 1}).empty()) next->perturbations.push_back(perturbation);
  next->playing = playing;
  next->speed = speed;
  next->due_at = playing && std::isfinite(speed) ? pace.done_at() : 0;
  next->achieved_speed = playing ? gauge.speed() : 0;
  next->step_seconds = step_seconds;
  next->springs_per_second = step_seconds > 0 && (playing || steps_left > 0)
                                 ? static_cast<double>(population.robots()->springs) / step_seconds
                                 : 0;
  told_at = wall_now();
  next->gathering_seconds = gathering_seconds = told_at - start;
  const std::lock_guard lock(mutex);
  snapshot = std::move(next);
  looked_at = false;
}

}  // namespace mercury
