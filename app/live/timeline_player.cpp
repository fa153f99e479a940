// SPDX-License-Identifier: Apache-2.0
#include "app/live/timeline_player.h"

#include <algorithm>
#include <limits>

namespace mercury {
namespace {

constexpr double keyframe_period = 0.25;      // wall time of steps between two keyframes, at least [s]
constexpr double keyframe_share = 0.02;       // of the time that keyframes may take
constexpr double near_target_seconds = 0.04;  // wall time of the steps from the last keyframe to a moment [s]

}  // namespace

void TimelinePlayer::clear() {
  replay_log_.restart();
  timeline_.clear();
  viewing_ = false;
  seek_target_.reset();
  loop_.reset();
  next_event_ = era_ = 0;
  work_ = keyframe_work_ = 0;
}

void TimelinePlayer::restart(bool with_keyframe) {
  clear();
  replay_log_.follow(batch_.simulation(), *batch_.robots(), batch_.perturbations());
  if (with_keyframe) keep_keyframe();
}

void TimelinePlayer::keep_keyframe() {
  if (!viewing_) {  // an earlier moment has an earlier clock
    timeline_.note(batch_.simulation().clock());
    keyframe_work_ = work_;
  }
  if (2 * sizeof(Vec3) * batch_.simulation().mass_count() > timeline_.budget()) return;
  const double start = wall_now();
  double work_before = work_;
  if (const Keyframe* last = viewing_ ? timeline_.before(batch_.steps()) : nullptr)
    work_before = last->work + static_cast<double>(batch_.steps() - last->step()) * stepping_.step_seconds();
  if (!viewing_) events_.seal();
  timeline_.add({.state = batch_.simulation().save(),
                 .configuration = batch_.configuration(),
                 .robots = batch_.robots(),
                 .perturbations = batch_.perturbations(),
                 .next_event = viewing_ ? next_event_ : events_.end(),
                 .era = era_,
                 .work = work_before,
                 .companions = comparison_.states()});
  keyframe_seconds_ = wall_now() - start;
}

void TimelinePlayer::stepped(double seconds) {
  work_ += seconds;
  replay_log_.stepped(seconds, batch_.simulation(), *batch_.robots());
  if (work_ - keyframe_work_ < std::max(keyframe_period, keyframe_seconds_ / keyframe_share)) return;
  keep_keyframe();
  const std::uint64_t needed = timeline_.empty() ? events_.end() : timeline_.front().next_event;
  events_.forget_before(std::min(needed, replay_log_.needed_events()));
}

void TimelinePlayer::follow_changes(bool robots_changed) {
  replay_log_.follow(batch_.simulation(), *batch_.robots(), batch_.perturbations());
  timeline_.note(batch_.simulation().clock());
  if (!robots_changed) return;
  ++era_;
  keep_keyframe();
}

// The last keyframe from which a moment of all robots can be computed. The companions may have begun at a moment before
// others that were kept already.
const Keyframe* TimelinePlayer::keyframe_before(std::int64_t step) const {
  const Keyframe* found =
      timeline_.before(step, [&](const Keyframe& keyframe) { return comparison_.can_show(keyframe); });
  return found ? found : timeline_.before(step);
}

void TimelinePlayer::begin_seek(std::int64_t step) {
  if (!viewing_) {
    keep_keyframe();
    head_step_ = batch_.steps();
    head_era_ = era_;
    next_event_ = events_.end();
  }
  if (timeline_.empty()) return;
  viewing_ = true;
  stepping_.drop();
  const std::int64_t first = timeline_.front().step(), target = std::clamp(step, first, std::max(first, head_step_));
  const Keyframe& keyframe = *keyframe_before(target);
  const bool is_ahead = batch_.steps() <= target && keyframe.step() <= batch_.steps() && keyframe.era <= era_;
  if (!is_ahead) show_keyframe(keyframe);
  seek_target_ = target;
  seek_is_near_ = false;
}

// `jumps`: the robots do not come here by stepping.
void TimelinePlayer::show_keyframe(const Keyframe& keyframe, bool jumps) {
  batch_.configure(keyframe.configuration);
  batch_.follow(keyframe.robots->robots);
  batch_.restore(keyframe.state);
  batch_.perturb(keyframe.perturbations);
  stepping_.forget_cost();
  next_event_ = keyframe.next_event;
  era_ = keyframe.era;
  if (shows_present_robots()) batch_.measure();
  comparison_.show(keyframe, jumps);
  if (shows_present_robots()) comparison_.measure();
}

void TimelinePlayer::advance_seek() {
  // `near` moves with the mean that it is made of, so the keyframe is kept where the target is near for the first time.
  const std::int64_t left = *seek_target_ - batch_.steps(), near = stepping_.steps_in(near_target_seconds);
  if (left <= near && !std::exchange(seek_is_near_, true) && left > 1 && keyframe_seconds_ < near_target_seconds)
    keep_keyframe();
  if (left > 0) take_steps_(std::min(left > near ? left - near : left, std::max(near / 4, std::int64_t{1})));
  if (batch_.steps() < *seek_target_) return;
  seek_target_.reset();
  if (batch_.steps() == head_step_ && !loop_) return_to_present();
  stepping_.start();
}

void TimelinePlayer::finish_seek() {
  while (seek_target_) advance_seek();
}

bool TimelinePlayer::loop_back() {
  if (!loop_ || !stepping_.playing() || batch_.steps() < timeline_.step_at(loop_->second)) return false;
  begin_seek(timeline_.step_at(loop_->first));
  return viewing_;
}

std::int64_t TimelinePlayer::limited(std::int64_t steps) const {
  if (loop_ && stepping_.playing())
    steps = std::clamp(timeline_.step_at(loop_->second) - batch_.steps(), std::int64_t{1}, steps);
  return viewing_ ? std::min(steps, head_step_ - batch_.steps()) : steps;
}

void TimelinePlayer::apply_events() {
  bool changed = false;
  for (;;) {
    if (const Keyframe* next = timeline_.next_era(era_); next && next->step() <= batch_.steps()) {
      show_keyframe(*next, false);
      continue;
    }
    const SceneEvent* event = events_.find(next_event_);
    if (!event || event->step > batch_.steps()) break;
    ++next_event_;
    changed = true;
    std::vector<LivePerturbation> perturbations = event->perturbations.value_or(batch_.perturbations());
    if (event->configuration) batch_.configure(*event->configuration);
    if (event->materials || event->by_hand) {
      std::vector<LiveRobot> robots = batch_.robots()->robots;
      for (LiveRobot& robot : robots) {
        if (event->materials && robot.id == event->materials->first) robot.materials = event->materials->second;
        if (event->by_hand && robot.id == event->by_hand->first) robot.by_hand = event->by_hand->second;
      }
      batch_.follow(robots);
    }
    batch_.perturb(std::move(perturbations));
  }
  if (!changed) return;
  comparison_.follow();
  stepping_.follow_time_step();
}

std::int64_t TimelinePlayer::next_event_step() const {
  std::int64_t stop = std::numeric_limits<std::int64_t>::max();
  if (const SceneEvent* event = events_.find(next_event_)) stop = event->step;
  if (const Keyframe* next = timeline_.next_era(era_)) stop = std::min(stop, next->step());
  return std::max(stop, batch_.steps() + 1);
}

void TimelinePlayer::arrive() {
  if (viewing_ && batch_.steps() == head_step_) return_to_present();
}

void TimelinePlayer::return_to_present() {
  if (!viewing_) return;
  seek_target_.reset();
  if (batch_.steps() != head_step_) {
    if (const Keyframe* last = keyframe_before(head_step_)) show_keyframe(*last);
    if (batch_.steps() < head_step_) take_steps_(head_step_ - batch_.steps());
  }
  apply_events();
  viewing_ = false;
  batch_.sample();
}

bool TimelinePlayer::make_present(bool with_keyframe) {
  finish_seek();
  if (!viewing_) return false;
  viewing_ = false;
  events_.cut(next_event_);
  timeline_.cut(batch_.steps(), era_);
  if (era_ != head_era_) batch_.measure_robots();
  batch_.cut_measures(batch_.steps());
  comparison_.forget_later();
  replay_log_.cut(batch_.simulation(), *batch_.robots(), batch_.perturbations());
  if (loop_ && loop_->second > batch_.time()) loop_.reset();
  if (with_keyframe) keep_keyframe();
  stepping_.start();
  return true;
}

TimelineState TimelinePlayer::state() const {
  TimelineState state{.begin = batch_.time(),
                      .head = viewing_ ? timeline_.time_at(head_step_) : batch_.time(),
                      .viewing = viewing_,
                      .seeking = is_seeking(),
                      .target = seek_target_ ? timeline_.time_at(*seek_target_) : batch_.time(),
                      .looping = loop_.has_value(),
                      .loop_begin = loop_ ? loop_->first : 0,
                      .loop_end = loop_ ? loop_->second : 0,
                      .bytes = timeline_.bytes(),
                      .budget = timeline_.budget(),
                      .keyframes = timeline_.size()};
  if (!timeline_.empty()) state.begin = std::min(state.begin, timeline_.time_at(timeline_.front().step()));
  return state;
}

std::function<Repro()> TimelinePlayer::repro(std::size_t robot) {
  return replay_log_.repro(batch_.simulation(), *batch_.robots(), robot, batch_.telemetry()[robot]);
}

}  // namespace mercury
