// SPDX-License-Identifier: Apache-2.0
#include "app/live/scene_time.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "app/live/scene_core.h"

namespace mercury {
namespace {

// Speeds in simulated seconds per second.
constexpr double slowest = 1e-3, fastest = 100;

constexpr std::array speeds{0.001, 0.002, 0.005, 0.01, 0.02,  0.05,           0.1, 0.2, 0.5, 1.0, 2.0,
                            5.0,   10.0,  20.0,  50.0, 100.0, unlimited_speed};

}  // namespace

void SceneTime::update() {
  if (std::exchange(stops_, core_.snapshot().stops) != core_.snapshot().stops) playing_ = false;
}

void SceneTime::play() {
  playing_ = true;
  core_.physics().play();
}
void SceneTime::pause() {
  playing_ = false;
  core_.physics().pause();
}
void SceneTime::toggle() { playing_ ? pause() : play(); }
void SceneTime::step(std::int64_t count) {
  playing_ = false;
  core_.physics().step(count);
}
void SceneTime::reset() { core_.reset(); }

void SceneTime::set_speed(double speed) {
  if (std::isnan(speed)) return;
  speed_ = speed == unlimited_speed ? speed : std::clamp(speed, slowest, fastest);
  core_.physics().set_speed(speed_);
}

void SceneTime::change_speed(int notches) {
  for (; notches > 0; --notches) {
    const auto next = std::upper_bound(speeds.begin(), speeds.end(), speed_ * (1 + 1e-9));
    if (next != speeds.end()) set_speed(*next);
  }
  for (; notches < 0; ++notches) {
    const auto next = std::lower_bound(speeds.begin(), speeds.end(), speed_ * (1 - 1e-9));
    if (next != speeds.begin()) set_speed(*(next - 1));
  }
}

void SceneTime::pause_on_explosion(bool pause) {
  if (std::exchange(pauses_on_explosion_, pause) != pause) core_.physics().pause_on_explosion(pause);
}

void SceneTime::seek(double time) {
  if (!std::isfinite(time)) return;
  core_.leave_moment();
  core_.physics().seek(time);
}
void SceneTime::step_back(std::int64_t count) {
  playing_ = false;
  core_.leave_moment();
  core_.physics().step_back(count);
}
void SceneTime::go_on() { core_.adopt_moment(); }

void SceneTime::set_loop(std::optional<std::pair<double, double>> times) {
  if (times && !(times = TimelineMarks::loop_between(times->first, times->second))) return;
  core_.marks().forget_loop();
  core_.physics().set_loop(times);
}

LoopMark SceneTime::mark_loop() {
  if (core_.snapshot().timeline.looping) {
    set_loop({});
    return LoopMark::ended;
  }
  const auto loop = core_.marks().mark_loop(core_.snapshot().time);
  if (!loop) return LoopMark::begun;
  set_loop(loop);
  return LoopMark::closed;
}

std::optional<double> SceneTime::loop_begin() const { return core_.marks().loop_begin(); }
const std::vector<double>& SceneTime::bookmarks() const { return core_.marks().bookmarks(); }
bool SceneTime::toggle_bookmark() { return core_.marks().toggle_bookmark(core_.snapshot().time); }

bool SceneTime::seek_bookmark(int direction) {
  const TimelineState& timeline = core_.snapshot().timeline;
  const auto next = core_.marks().next_bookmark(timeline.seeking ? timeline.target : core_.snapshot().time, direction);
  if (next) seek(*next);
  return next.has_value();
}

void SceneTime::set_timeline_budget(std::size_t bytes) { core_.physics().set_timeline_budget(bytes); }

}  // namespace mercury
