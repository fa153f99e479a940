// SPDX-License-Identifier: Apache-2.0
// The timeline on the physics thread: keeps keyframes, shows earlier moments, and makes one the present again.
//
// A moment is shown by restoring the keyframe before it and stepping on, with the same changes at the same steps. The
// steps are made in slices like all others, so a new command, such as the next moment of a scrubbing mouse, takes
// effect at once. On the way a keyframe is kept shortly before the moment: stepping back from there is quick.
#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "app/live/physics_parts.h"

namespace mercury {
namespace {

constexpr double keyframe_period = 0.25;      // wall time of steps between two keyframes, at least [s]
constexpr double keyframe_share = 0.02;       // of the time that keyframes may take
constexpr double near_target_seconds = 0.04;  // wall time of the steps from the last keyframe to a moment [s]

}  // namespace

// Whatever changes the robots makes the moment that is shown the present first.
void Physics::Parts::prepare_changes(const PendingCommands& taken) {
  if (taken.timeline_budget) timeline.set_budget(*taken.timeline_budget);
  if (taken.seek_first) seek(*taken.seek_first);
  const bool changes = taken.scene || taken.go_on || (taken.perturbations && *taken.perturbations != perturbations);
  if (viewing && changes) make_present();
  if (viewing && taken.reset && !recording) return_to_present();
}

void Physics::Parts::carry_out_seek(const PendingCommands& taken) {
  if (taken.loop) loop = *taken.loop;
  if (taken.seek) seek(*taken.seek);
  if (taken.steps_back > 0 && recording)
    show_recording(recording->time(recording->frame_at(std::nextafter(recording_time, recording->time(0)))));
  else if (taken.steps_back > 0)
    begin_seek(seek_target.value_or(simulation.steps()) - taken.steps_back);
  // Playing a recording at its end plays it again.
  if (recording && taken.playing && *taken.playing && recording_time >= recording->time(recording->frames() - 1))
    show_recording(recording->time(0));
}

void Physics::Parts::seek(double time) { recording ? show_recording(time) : begin_seek(timeline.step_at(time)); }

// Time starts again, or the past cannot be reached any more.
void Physics::Parts::restart_timeline() {
  clear_timeline();
  keep_keyframe();
}

void Physics::Parts::clear_timeline() {
  timeline.clear();
  viewing = false;
  seek_target.reset();
  loop.reset();
  next_event = era = 0;
  work = keyframe_work = 0;
}

void Physics::Parts::keep_keyframe() {
  if (!viewing) {  // an earlier moment has an earlier clock
    timeline.note(simulation.clock());
    keyframe_work = work;
  }
  if (simulation.size() == 0 || 2 * sizeof(Vec3) * simulation.mass_count() > timeline.budget()) return;
  const double start = wall_now();
  double work_before = work;
  if (const Keyframe* last = viewing ? timeline.before(simulation.steps()) : nullptr)
    work_before = last->work + static_cast<double>(simulation.steps() - last->step()) * step_seconds;
  if (!viewing) events.seal();
  timeline.add({.state = simulation.save(),
                .configuration = simulation.configuration(),
                .robots = population.robots(),
                .perturbations = perturbations,
                .next_event = viewing ? next_event : events.end(),
                .era = era,
                .work = work_before,
                .second = state_of(second),
                .ghosts = state_of(ghosts)});
  keyframe_seconds = wall_now() - start;
}

void Physics::Parts::keep_due_keyframe() {
  if (work - keyframe_work < std::max(keyframe_period, keyframe_seconds / keyframe_share)) return;
  keep_keyframe();
  const std::uint64_t needed = timeline.empty() ? events.end() : timeline.front().next_event;
  events.forget_before(std::min(needed, replay_log.needed_events()));
}

// Call it after the robots, their parameters or what acts on them may have changed.
void Physics::Parts::follow_changes(bool robots_changed) {
  replay_log.follow(simulation, *population.robots(), perturbations);
  timeline.note(simulation.clock());
  if (!robots_changed) return;
  ++era;
  keep_keyframe();
}

void Physics::Parts::begin_seek(std::int64_t step) {
  if (!viewing) {
    keep_keyframe();
    head_step = simulation.steps();
    head_era = era;
    next_event = events.end();
  }
  if (timeline.empty()) return;
  viewing = true;
  steps_left = 0;
  const std::int64_t target = std::clamp(step, timeline.front().step(), std::max(timeline.front().step(), head_step));
  const Keyframe& keyframe = *keyframe_before(target);
  const bool is_ahead = simulation.steps() <= target && keyframe.step() <= simulation.steps() && keyframe.era <= era;
  if (!is_ahead) show_keyframe(keyframe);
  seek_target = target;
  seek_is_near = false;
}

void Physics::Parts::show_keyframe(const Keyframe& keyframe, bool jumps) {
  simulation.set_perturbations({});
  const bool tuned = simulation.configuration() != keyframe.configuration;
  if (tuned) simulation.configure(keyframe.configuration);
  const bool others = population.robots() != keyframe.robots && population.follow(keyframe.robots->robots);
  simulation.restore(keyframe.state);
  step_seconds = 0;
  perturbations = keyframe.perturbations;
  simulation.set_perturbations(population.perturbations_of(perturbations));
  next_event = keyframe.next_event;
  era = keyframe.era;
  telemetry = simulation.telemetry();
  if (era == head_era) measurements.observe(simulation.time(), simulation.steps(), telemetry);
  if (tuned || others) observe_details();
  show_companions(keyframe, jumps);
  ++resets;
  dirty = true;
}

// A slice of the steps to the moment that is to be shown.
void Physics::Parts::advance_seek() {
  const auto steps_in = [&](double seconds) {
    return step_seconds > 0 ? static_cast<std::int64_t>(std::clamp(seconds / step_seconds, 1.0, 1e6)) : 1;
  };
  // `near` moves with the mean that it is made of, so the keyframe is kept where the target is near for the first time.
  const std::int64_t left = *seek_target - simulation.steps(), near = steps_in(near_target_seconds);
  if (left <= near && !std::exchange(seek_is_near, true) && left > 1 && keyframe_seconds < near_target_seconds)
    keep_keyframe();
  if (left > 0) take_steps(std::min(left > near ? left - near : left, std::max(near / 4, std::int64_t{1})));
  if (simulation.steps() < *seek_target) return;
  seek_target.reset();
  if (simulation.steps() == head_step && !loop) return_to_present();
  begin_pace();
  dirty = true;
}

void Physics::Parts::finish_seek() {
  while (seek_target) advance_seek();
}

// Applies the changes of the past that are due at the present step.
void Physics::Parts::apply_events() {
  bool changed = false, tuned = false;
  for (;;) {
    if (const Keyframe* next = timeline.next_era(era); next && next->step() <= simulation.steps()) {
      show_keyframe(*next, false);
      continue;
    }
    const SceneEvent* event = events.find(next_event);
    if (!event || event->step > simulation.steps()) break;
    ++next_event;
    changed = true;
    if (event->configuration) {
      simulation.configure(*event->configuration);
      tuned = true;
    }
    if (event->materials) {
      std::vector<LiveRobot> robots = population.robots()->robots;
      for (LiveRobot& robot : robots)
        if (robot.id == event->materials->first) robot.materials = event->materials->second;
      population.follow(robots);
    }
    if (event->perturbations) perturbations = *event->perturbations;
  }
  if (!changed) return;
  simulation.set_perturbations(population.perturbations_of(perturbations));
  follow_companions();
  if (tuned) {
    observe_details();
    begin_pace();
  }
}

// The step of the next change of the past.
std::int64_t Physics::Parts::next_stop() const {
  std::int64_t stop = std::numeric_limits<std::int64_t>::max();
  if (const SceneEvent* event = events.find(next_event)) stop = event->step;
  if (const Keyframe* next = timeline.next_era(era)) stop = std::min(stop, next->step());
  return std::max(stop, simulation.steps() + 1);
}

// From an earlier moment, the robots have come to the present, or go there now.
void Physics::Parts::return_to_present() {
  if (!viewing) return;
  seek_target.reset();
  if (simulation.steps() != head_step) {
    if (const Keyframe* last = keyframe_before(head_step)) show_keyframe(*last);
    if (simulation.steps() < head_step) take_steps(head_step - simulation.steps());
  }
  apply_events();
  viewing = false;
  telemetry = simulation.telemetry();
  dirty = true;
}

// The moment that is shown becomes the present.
void Physics::Parts::make_present() {
  if (recording) return leave_recording();
  finish_seek();
  if (!viewing) return;
  viewing = false;
  forget_later();
}

void Physics::Parts::forget_later() {
  const LiveRobots& robots = *population.robots();
  events.cut(next_event);
  timeline.cut(simulation.steps(), era);
  if (era != head_era)
    measurements.set_robots(robots, simulation.time(), simulation.configuration().environment, telemetry);
  measurements.cut(simulation.time(), simulation.steps());
  forget_later_companions();
  replay_log.cut(simulation, robots, perturbations);
  if (loop && loop->second > simulation.time()) loop.reset();
  if (replayed_repro)
    for (next_change = 0; next_change_step() < simulation.steps();) ++next_change;
  {
    const std::lock_guard lock(mutex);
    std::erase_if(exploded, [&](RobotId id) {
      const auto index = robots.index_of(id);
      const bool gone = !index || !telemetry[*index].exploded;
      if (gone) repros.erase(id);
      return gone;
    });
  }
  keep_keyframe();
  begin_pace();
  dirty = true;
}

// Starts the loop again if it is at its end. Returns whether it was.
bool Physics::Parts::loop_back() {
  if (!loop || !playing || simulation.steps() < timeline.step_at(loop->second)) return false;
  begin_seek(timeline.step_at(loop->first));
  return viewing;
}

TimelineState Physics::Parts::timeline_state() const {
  TimelineState state{.begin = simulation.time(),
                      .head = simulation.time(),
                      .viewing = viewing,
                      .recording = recording != nullptr,
                      .seeking = seek_target.has_value(),
                      .target = simulation.time(),
                      .looping = loop.has_value(),
                      .loop_begin = loop ? loop->first : 0,
                      .loop_end = loop ? loop->second : 0,
                      .bytes = timeline.bytes(),
                      .budget = timeline.budget(),
                      .keyframes = timeline.size()};
  if (recording) {
    state.begin = recording->time(0);
    state.head = recording->time(recording->frames() - 1);
    return state;
  }
  if (!timeline.empty()) state.begin = std::min(state.begin, timeline.time_at(timeline.front().step()));
  if (viewing) state.head = timeline.time_at(head_step);
  if (seek_target) state.target = timeline.time_at(*seek_target);
  return state;
}

}  // namespace mercury
