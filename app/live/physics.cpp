// SPDX-License-Identifier: Apache-2.0
#include "app/live/physics.h"

#include <algorithm>
#include <atomic>
#include <exception>
#include <set>
#include <thread>

#include "app/live/physics_exchange.h"
#include "app/live/recording_player.h"
#include "app/live/timeline_player.h"

namespace mercury {

// The physics thread: takes commands, carries them out, steps, and publishes snapshots. All members but the exchange
// and what is thread-safe belong to it.
struct PhysicsThread::Parts {
  Parts(const Configuration& configuration, Messages& all)
      : messages(all), batch(configuration, measurements, messages), device(batch.simulation().device_name()),
        cuda_device(batch.simulation().cuda_device()) {
    batch.watch({});
  }

  Exchange exchange;
  Messages& messages;
  Measurements measurements;
  ExplosionLog explosions;
  std::atomic<bool> velocities_wanted = false;

  LiveBatch batch;
  const std::string device;
  const int cuda_device;
  Stepping stepping{batch};
  Comparison comparison{batch, messages};
  TimelinePlayer timeline{batch, comparison, stepping, [this](std::int64_t count) { take_steps(count); }};
  RecordingPlayer recording{batch, stepping};
  ReproPlayer repro{batch};
  std::set<std::string> reported_notes;
  RobotId watched_brain = 0;
  bool stop_at_explosion = false;
  bool dirty = true;   // something changed after the last snapshot
  std::thread thread;  // last: it starts when all other members exist

  bool is_viewing() const { return recording.is_open() || timeline.is_viewing(); }
  void run();
  PendingCommands wait_for_commands();
  bool guarded(auto task);
  void carry_out(PendingCommands& taken);
  void begin_again(PendingCommands& taken);
  void change_robots(PendingCommands& taken, bool scene_changed, bool robots_changed);
  void prepare_changes(const PendingCommands& taken);
  bool set_scene(const PendingCommands::Scene& scene);
  void forget_all();
  void restart();
  void play_recording(std::shared_ptr<TrajectoryReader> reader);
  void show_recording(double time);
  void seek(double time);
  void carry_out_seek(const PendingCommands& taken);
  void make_present(bool with_keyframe);
  bool advance();
  void take_steps(std::int64_t count);
  void note_explosions() { explosions.note(*batch.robots(), batch.telemetry()); }
  void publish_snapshot();
};

PhysicsThread::PhysicsThread(const Configuration& configuration, Messages& messages)
    : parts_(std::make_unique<Parts>(configuration, messages)) {
  parts_->publish_snapshot();
  parts_->thread = std::thread([parts = parts_.get()] { parts->run(); });
}

PhysicsThread::~PhysicsThread() {
  parts_->exchange.request([](PendingCommands& pending) { pending.quit = true; });
  parts_->thread.join();
}

void PhysicsThread::set_scene(std::vector<LiveRobot> robots, const Configuration& configuration,
                              std::uint64_t surroundings) {
  parts_->exchange.request([&](PendingCommands& pending) {
    pending.scene = {std::move(robots), configuration, nullptr, nullptr, surroundings};
  });
}
void PhysicsThread::set_repro(const LiveRobot& robot, const Configuration& configuration, std::uint64_t surroundings,
                              std::shared_ptr<const Repro> repro) {
  parts_->exchange.request([&](PendingCommands& pending) {
    pending.scene = {std::vector{robot}, configuration, std::move(repro), nullptr, surroundings};
    pending.steps = 0;
    pending.drop_timeline();
  });
}
void PhysicsThread::set_recording(std::vector<LiveRobot> robots, const Configuration& configuration,
                                  std::uint64_t surroundings, std::shared_ptr<TrajectoryReader> recording) {
  parts_->exchange.request([&](PendingCommands& pending) {
    pending.scene = {std::move(robots), configuration, nullptr, std::move(recording), surroundings};
    pending.steps = 0;
    pending.drop_timeline();
  });
}
void PhysicsThread::seek(double time) {
  parts_->exchange.request([&](PendingCommands& pending) {
    pending.seek = time;
    pending.steps_back = 0;
  });
}
void PhysicsThread::step_back(std::int64_t count) {
  parts_->exchange.request([&](PendingCommands& pending) {
    pending.playing = false;
    pending.steps_back += std::max<std::int64_t>(0, count);
  });
}
void PhysicsThread::go_on() {
  parts_->exchange.request([&](PendingCommands& pending) {
    pending.go_on = true;
    if (pending.seek) pending.seek_first = std::exchange(pending.seek, {});
  });
}
void PhysicsThread::set_loop(std::optional<std::pair<double, double>> times) {
  parts_->exchange.set(&PendingCommands::loop, times);
}
void PhysicsThread::set_timeline_budget(std::size_t bytes) {
  parts_->exchange.set(&PendingCommands::timeline_budget, bytes);
}
void PhysicsThread::set_start(const TrialStart& start) { parts_->exchange.set(&PendingCommands::start, start); }
void PhysicsThread::set_view(const ViewSettings& settings) { parts_->exchange.set(&PendingCommands::view, settings); }
void PhysicsThread::set_perturbations(std::vector<LivePerturbation> perturbations) {
  parts_->exchange.set(&PendingCommands::perturbations, std::move(perturbations));
}
void PhysicsThread::set_bridge(std::shared_ptr<PositionBridge> bridge) {
  parts_->exchange.set(&PendingCommands::bridge, std::move(bridge));
}
int PhysicsThread::cuda_device() const { return parts_->cuda_device; }
void PhysicsThread::play() {
  parts_->exchange.request([](PendingCommands& pending) {
    pending.playing = pending.drop_steps = true;
    pending.steps = 0;
  });
}
void PhysicsThread::pause() {
  parts_->exchange.request([](PendingCommands& pending) {
    pending.playing = false;
    pending.drop_steps = true;
    pending.steps = 0;
  });
}
void PhysicsThread::set_speed(double speed) {
  if (!(speed > 0)) return;
  parts_->exchange.set(&PendingCommands::speed, speed);
}
void PhysicsThread::step(std::int64_t count) {
  parts_->exchange.request([&](PendingCommands& pending) {
    pending.playing = false;
    pending.steps += std::max<std::int64_t>(0, count);
  });
}
void PhysicsThread::reset() {
  parts_->exchange.request([](PendingCommands& pending) {
    pending.reset = true;
    pending.steps = 0;
    pending.drop_timeline();
  });
}
void PhysicsThread::pause_on_explosion(bool pause) {
  parts_->exchange.set(&PendingCommands::pause_on_explosion, pause);
}

void PhysicsThread::set_second(std::optional<SideDifference> difference) {
  parts_->exchange.set(&PendingCommands::difference, std::move(difference));
}
void PhysicsThread::set_ghosts(std::vector<LiveRobot> ghosts) {
  parts_->exchange.set(&PendingCommands::ghosts, std::move(ghosts));
}
const Measurements& PhysicsThread::second_measurements() const { return parts_->comparison.second_measurements(); }
const Measurements& PhysicsThread::ghost_measurements() const { return parts_->comparison.ghost_measurements(); }

void PhysicsThread::watch_velocities(bool watch) { parts_->velocities_wanted = watch; }
void PhysicsThread::watch_brain(RobotId robot) { parts_->exchange.set(&PendingCommands::brain, robot); }

std::shared_ptr<const Snapshot> PhysicsThread::newest() { return parts_->exchange.newest(); }
std::vector<Explosion> PhysicsThread::take_explosions() { return parts_->explosions.take(); }
std::optional<Repro> PhysicsThread::repro(RobotId robot) const { return parts_->explosions.repro(robot); }
const Measurements& PhysicsThread::measurements() const { return parts_->measurements; }
std::string PhysicsThread::device_name() const { return parts_->device; }
void PhysicsThread::wait_until_done() { parts_->exchange.wait_until_done(); }

void PhysicsThread::Parts::run() {
  stepping.start();
  for (PendingCommands taken = wait_for_commands(); !taken.quit; taken = wait_for_commands()) {
    guarded([&] { carry_out(taken); });
    guarded([&] { dirty = advance() || dirty; });
    if (!dirty || !exchange.is_wanted() || !(stepping.may_publish() || exchange.is_awaited())) continue;
    dirty = false;  // also if publishing fails, so that the failure is not repeated
    guarded([&] { publish_snapshot(); });
  }
}

// Waits for commands or for the time of the next step; on a GPU that the window watches, for that of its next frame.
PendingCommands PhysicsThread::Parts::wait_for_commands() {
  const bool wanted = exchange.is_wanted();
  double due = std::numeric_limits<double>::infinity();
  if (stepping.is_running()) due = stepping.is_unlimited() ? 0 : std::min(stepping.next_due(wanted), wall_now() + 1);
  return exchange.take({.idle = stepping.left() == 0 && !timeline.is_seeking(),
                        .unpublished = dirty,
                        .wakes_for_snapshot = stepping.interrupts_device() && !wanted,
                        .due = due});
}

// A failure of physics must not end the window: reports the error, pauses, and returns false.
bool PhysicsThread::Parts::guarded(auto task) {
  try {
    task();
    return true;
  } catch (const std::exception& error) {
    messages.add(Severity::error, error.what());
    stepping.stop();
    timeline.stop_seeking();
  }
  return false;
}

void PhysicsThread::Parts::carry_out(PendingCommands& taken) {
  if (!taken.any()) return;
  dirty = true;
  // What fails pauses the robots. What was taken with it takes effect.
  if (taken.pause_on_explosion) stop_at_explosion = *taken.pause_on_explosion;
  bool fails = !guarded([&] { prepare_changes(taken); });
  if (taken.start) batch.set_start(*taken.start);
  bool robots_changed = false;
  const bool scene_changed = taken.scene.has_value();
  if (taken.scene && !guarded([&] { robots_changed = set_scene(*taken.scene); })) {
    fails = robots_changed = true;
    taken.scene.reset();  // it is empty now
  }
  if (taken.view) batch.watch(*taken.view);
  if (taken.view) comparison.watch(*taken.view);
  if (taken.brain) watched_brain = *taken.brain;
  if (!guarded([&] { begin_again(taken); })) fails = true;
  if (!guarded([&] { change_robots(taken, scene_changed, robots_changed); })) fails = true;
  if (taken.bridge) batch.set_bridge(std::move(*taken.bridge));
  if (robots_changed) stepping.forget_cost();
  if (taken.speed) stepping.set_speed(*taken.speed);
  if (taken.playing && !fails) stepping.play(*taken.playing);
  if (taken.drop_steps) stepping.drop();
  if (guarded([&] { carry_out_seek(taken); }) && !fails) stepping.add(taken.steps);
  if (taken.playing || taken.speed || taken.reset || taken.seek || robots_changed) stepping.start();
  stepping.follow_time_step();
}

// Who goes along, and where all begin.
void PhysicsThread::Parts::begin_again(PendingCommands& taken) {
  if (taken.difference) comparison.set_second(*taken.difference);
  if (taken.ghosts) comparison.set_ghosts(std::move(*taken.ghosts));
  if (taken.scene && taken.scene->recording)
    play_recording(taken.scene->recording);
  else if (recording.is_open() && taken.reset)
    show_recording(recording.begin());
  else if (taken.reset || (taken.scene && repro.is_set()))
    restart();
}

// What acts on the robots of the scene.
void PhysicsThread::Parts::change_robots(PendingCommands& taken, bool scene_changed, bool robots_changed) {
  const bool perturbed = taken.perturbations || scene_changed;
  if (perturbed) {
    batch.perturb(taken.perturbations ? std::move(*taken.perturbations) : batch.perturbations());
    comparison.follow();
  }
  // While a recording is played nothing goes along: nothing is simulated.
  if (recording.is_open() || batch.empty()) {
    comparison.end();
  } else if (comparison.must_begin()) {
    timeline.finish_seek();
    comparison.begin();
    stepping.start();
  }
  if ((perturbed || taken.reset) && !is_viewing()) timeline.follow_changes(robots_changed);
}

// Whatever changes the robots makes the moment that is shown the present first.
void PhysicsThread::Parts::prepare_changes(const PendingCommands& taken) {
  if (taken.timeline_budget) timeline.set_budget(*taken.timeline_budget);
  if (taken.seek_first) seek(*taken.seek_first);
  const bool perturbed = taken.perturbations && *taken.perturbations != batch.perturbations();
  // A recording begins a past of its own.
  const bool keeps_past = !taken.scene || !taken.scene->recording;
  if (is_viewing() && (taken.scene || taken.go_on || perturbed)) make_present(keeps_past);
  if (taken.reset) timeline.return_to_present();
}

// Returns whether the list of robots or the kind of environment changed.
bool PhysicsThread::Parts::set_scene(const PendingCommands::Scene& scene) {
  repro.set(scene.repro);
  const Configuration before = batch.configuration();
  const std::int64_t steps = batch.steps();
  const bool at_start = steps == 0, first = batch.empty() && at_start;
  const bool moves = scene.surroundings != batch.surroundings();
  bool changed = false;
  try {
    changed = batch.move(scene.robots, scene.configuration, scene.surroundings);
  } catch (...) {
    if (batch.empty()) forget_all();
    throw;
  }
  if (moves) {
    if (batch.steps() == steps) {
      timeline.forget_states();
    } else {  // undo or redo
      timeline.restart();
      batch.cut_measures(batch.steps());
    }
    stepping.forget_cost();
    explosions.forget_whole(*batch.robots(), batch.telemetry());
  }
  if (first || (at_start && scene.configuration.dt != before.dt))
    batch.restart_measures();
  else
    batch.measure_robots();
  if (first) batch.measure();
  if (!changed) return !same_parts(before.environment, scene.configuration.environment);
  explosions.forget_absent(*batch.robots());
  note_explosions();
  for (const std::string& note : batch.simulation().notes())
    if (reported_notes.insert(note).second) messages.add(Severity::note, note);
  return true;
}

// The robots could not be simulated, and none is there now.
void PhysicsThread::Parts::forget_all() {
  comparison.end();
  explosions.forget_absent(*batch.robots());
  repro.set(nullptr);
  recording.close();
  timeline.restart();
  batch.restart_measures();
}

// Returns all robots to where they begin, at time 0, or a replay to its start.
void PhysicsThread::Parts::restart() {
  batch.reset();
  stepping.forget_cost();  // exploded robots cost nothing until now
  stepping.drop();
  explosions.clear();
  if (repro.is_set()) {
    repro.begin();
    stepping.start();
  }
  timeline.restart();
  batch.sample();
  batch.restart_measures();
  batch.measure();
  comparison.restart();
}

void PhysicsThread::Parts::play_recording(std::shared_ptr<TrajectoryReader> reader) {
  timeline.clear();
  try {
    recording.open(std::move(reader));
  } catch (...) {
    recording.close();
    timeline.restart();
    throw;
  }
  note_explosions();
}

void PhysicsThread::Parts::show_recording(double time) {
  recording.show(time);
  note_explosions();
}

void PhysicsThread::Parts::seek(double time) { recording.is_open() ? show_recording(time) : timeline.seek(time); }

void PhysicsThread::Parts::carry_out_seek(const PendingCommands& taken) {
  if (taken.loop) timeline.set_loop(*taken.loop);
  if (taken.seek) seek(*taken.seek);
  if (taken.steps_back > 0 && recording.is_open())
    show_recording(recording.previous());
  else if (taken.steps_back > 0)
    timeline.step_back(taken.steps_back);
  // Playing a recording at its end plays it again.
  if (recording.is_open() && taken.playing && *taken.playing && recording.is_at_end())
    show_recording(recording.begin());
}

// The moment that is shown becomes the present.
void PhysicsThread::Parts::make_present(bool with_keyframe) {
  if (recording.is_open()) {
    recording.leave();
    batch.cut_measures(batch.steps());
    timeline.restart(with_keyframe);
    stepping.start();
  } else if (timeline.make_present(with_keyframe)) {
    repro.skip();
  } else {
    return;
  }
  explosions.forget_whole(*batch.robots(), batch.telemetry());
}

// Makes one slice of the steps that are due. Returns whether anything changed.
bool PhysicsThread::Parts::advance() {
  if (timeline.is_seeking()) {
    timeline.advance_seek();
    return true;
  }
  if (batch.empty()) stepping.drop();
  if (stepping.left() == 0 && !stepping.is_running()) return false;
  if (recording.is_open()) {
    if (!recording.advance(timeline.loop())) return false;
    note_explosions();
    return true;
  }
  if (timeline.loop_back()) return true;
  const std::int64_t affordable = timeline.limited(stepping.slice());
  if (affordable <= 0) {
    timeline.return_to_present();
    return true;
  }
  if (stepping.left() > 0) {
    const std::int64_t count = std::min(affordable, stepping.left());
    take_steps(count);
    stepping.add(-std::min(count, stepping.left()));
    timeline.arrive();
    return true;
  }
  const std::int64_t count = std::min(affordable, stepping.due(exchange.was_watched()));
  if (count <= 0) return false;
  take_steps(count);
  stepping.done(count);
  if (!timeline.loop()) timeline.arrive();
  return true;
}

// Interrupts the steps where a sample of the telemetry is due and where a replay changes something.
void PhysicsThread::Parts::take_steps(std::int64_t count) {
  const bool viewing = timeline.is_viewing();
  const std::int64_t target = batch.steps() + count;
  double spent = 0, measuring = 0;
  while (batch.steps() < target) {
    if (viewing) {
      timeline.apply_events();
    } else if (repro.advance()) {
      comparison.follow();
      timeline.follow_changes(false);
      stepping.follow_time_step();
    }
    const std::int64_t sample = std::max(std::min(batch.next_measure(), comparison.next_measure()), batch.steps() + 1);
    const std::int64_t change = viewing ? timeline.next_event_step() : repro.next_step();
    const std::int64_t stop = std::min({target, sample, change, comparison.next_beginning()});
    const double start = wall_now();
    batch.step(stop - batch.steps());
    comparison.advance();
    const double stepped = wall_now();
    spent += stepped - start;
    if (stop != sample && stop != target) continue;
    batch.sample();
    if (timeline.shows_present_robots()) {
      batch.measure();
      comparison.measure();
    }
    const auto repro_of = [&](std::size_t robot) { return timeline.repro(robot); };
    const bool exploded = !viewing && explosions.note(*batch.robots(), batch.telemetry(), repro_of);
    measuring += wall_now() - stepped;
    if (!exploded || !stop_at_explosion) continue;
    stepping.stop();
    break;
  }
  if (stepping.took(count, spent, measuring)) {
    batch.thin_measures();
    comparison.thin_measures();
  }
  if (!viewing) timeline.stepped(spent);
}

void PhysicsThread::Parts::publish_snapshot() {
  const double start = wall_now();
  // On a GPU, velocities are a copy, and the steps wait for it.
  const bool with_velocities = !stepping.playing() || velocities_wanted || exchange.is_awaited();
  std::shared_ptr<Snapshot> next = batch.snapshot(with_velocities);
  next->timeline = timeline.state();
  if (watched_brain != 0 && (!recording.is_open() || recording.has_brain_of(watched_brain)))
    next->brain = batch.brain_of(watched_brain);
  next->brain_history = next->brain && recording.is_open() ? recording.history_of(watched_brain) : nullptr;
  if (recording.is_open()) {
    next->timeline.viewing = next->timeline.recording = true;
    next->timeline.begin = recording.begin();
    next->timeline.head = recording.end();
  }
  stepping.describe(*next);
  comparison.publish(*next, with_velocities);
  next->gathering_seconds = stepping.published(start);
  exchange.publish(std::move(next));
}

}  // namespace mercury
