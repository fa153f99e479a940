// SPDX-License-Identifier: Apache-2.0
#include "app/live/stepping.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace mercury {

void Pace::start(double wall, double speed, double dt) {
  start_ = wall;
  rate_ = speed / dt;
  done_ = 0;
}

std::int64_t Pace::due(double wall) {
  if (std::isinf(rate_)) return std::numeric_limits<std::int64_t>::max();
  const double wanted = (wall - start_) * rate_;
  const double late = (wanted - static_cast<double>(done_)) / rate_;
  if (late > most_late && wanted - static_cast<double>(done_) > 1) {
    start_ = wall - std::max(most_late, 1 / rate_);
    done_ = 0;
    return static_cast<std::int64_t>(std::max(1.0, most_late * rate_));
  }
  return static_cast<std::int64_t>(std::floor(wanted + 1e-9)) - done_;
}

double Pace::next_due(std::int64_t steps) const { return start_ + static_cast<double>(done_ + steps) / rate_; }

void SpeedGauge::mark(double wall, double time) {
  constexpr double span = 1;  // [s]
  marks_.push_back({wall, time});
  // Keep one mark older than the span, so that slow motion with few steps is measured, too.
  while (marks_.size() > 2 && marks_[1].wall < wall - span) marks_.pop_front();
}

double SpeedGauge::speed() const {
  if (marks_.size() < 2 || !(marks_.back().wall > marks_.front().wall)) return 0;
  return (marks_.back().time - marks_.front().time) / (marks_.back().wall - marks_.front().wall);
}

bool Stepping::is_unlimited() const { return !std::isfinite(speed_); }

std::int64_t Stepping::steps_in(double seconds) const {
  return step_seconds_ > 0 ? static_cast<std::int64_t>(std::clamp(seconds / step_seconds_, 1.0, 1e6)) : 1;
}

void Stepping::stop() {
  playing_ = false;
  left_ = 0;
  ++stops_;
}

void Stepping::start() {
  dt_ = batch_.configuration().dt;
  pace_.start(wall_now(), speed_, dt_);
  gauge_.clear();
  gauge_.mark(wall_now(), batch_.time());
}

void Stepping::follow_time_step() {
  if (batch_.configuration().dt != dt_) start();
}

// A GPU that also draws switches to the steps and back in about 2 ms, so they come once per frame: when the window
// wants a snapshot, else after this many.
std::int64_t Stepping::at_once() const {
  constexpr double launch_period = 0.05;  // wall time [s]
  if (cuda_device_ < 0 || is_unlimited()) return 1;
  return std::max<std::int64_t>(1, std::llround(launch_period * speed_ / batch_.configuration().dt));
}

double Stepping::next_due(bool watched) const { return pace_.next_due(watched ? 1 : at_once()); }

std::int64_t Stepping::due(bool watched) {
  const std::int64_t due = pace_.due(wall_now());
  return due < (watched ? 1 : at_once()) ? 0 : due;
}

// Several steps per call are faster for large batches, because the state stays in the cache.
std::int64_t Stepping::slice() const {
  constexpr double usual = 0.015, longest = 0.1;  // wall time between two looks at the commands [s]
  return std::max(steps_in(usual), std::min(steps_in(longest), std::int64_t{16}));
}

void Stepping::done(std::int64_t steps) {
  pace_.done(steps);
  gauge_.mark(wall_now(), batch_.time());
}

bool Stepping::took(std::int64_t steps, double stepping, double measuring) {
  constexpr double most = 0.02, enough = 0.05;  // share of the time; [s] of steps before it is known
  const double each = stepping / static_cast<double>(steps);
  step_seconds_ = step_seconds_ > 0 ? 0.8 * step_seconds_ + 0.2 * each : each;
  stepping_ += stepping;
  measuring_ += measuring;
  if (stepping_ < enough) return false;
  const bool too_much = playing_ && is_unlimited() && measuring_ > most * stepping_;
  stepping_ = measuring_ = 0;
  return too_much;
}

bool Stepping::may_publish() const {
  constexpr double share = 0.05;
  return !playing_ || !is_unlimited() || wall_now() - published_at_ >= (1 / share - 1) * gathering_;
}

void Stepping::describe(Snapshot& next) const {
  next.playing = playing_;
  next.speed = speed_;
  next.stops = stops_;
  next.due_at = playing_ && !is_unlimited() ? pace_.done_at() : 0;
  next.achieved_speed = playing_ ? gauge_.speed() : 0;
  next.step_seconds = step_seconds_;
  std::size_t springs = batch_.robots()->springs;
  for (std::size_t i = 0; i < next.telemetry.size(); ++i)
    if (next.telemetry[i].exploded) springs -= next.robots->robots[i].robot->springs.size();  // it stands still
  next.springs_per_second =
      step_seconds_ > 0 && (playing_ || left_ > 0) ? static_cast<double>(springs) / step_seconds_ : 0;
}

double Stepping::published(double started) {
  published_at_ = wall_now();
  return gathering_ = published_at_ - started;
}

}  // namespace mercury
