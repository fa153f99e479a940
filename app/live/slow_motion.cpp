// SPDX-License-Identifier: Apache-2.0
#include "app/live/slow_motion.h"

#include <algorithm>
#include <cmath>

namespace mercury {
namespace {

constexpr std::size_t most_snapshots = 5;

Vec3 between(Vec3 a, Vec3 b, float t) { return a + t * (b - a); }

// Steps per second of wall time; 0 = paused or unlimited.
double rate_of(const Snapshot& snapshot) {
  return snapshot.playing && std::isfinite(snapshot.speed) ? snapshot.speed / snapshot.configuration.dt : 0;
}

bool is_slow(const Snapshot& snapshot) {
  const double rate = rate_of(snapshot);
  return rate > 0 && rate <= SlowMotion::most_rate;
}

}  // namespace

void SlowMotion::take(std::shared_ptr<const Snapshot> snapshot) {
  if (!snapshots_.empty()) {
    const Snapshot& last = *snapshots_.back();
    const bool other = last.robots->revision != snapshot->robots->revision || last.resets != snapshot->resets ||
                       snapshot->steps < last.steps;
    if (other || !is_slow(*snapshot))
      snapshots_.clear();
    else if (last.steps == snapshot->steps)
      snapshots_.pop_back();
  }
  snapshots_.push_back(std::move(snapshot));
  if (snapshots_.size() > most_snapshots) snapshots_.pop_front();
  if (snapshots_.size() == 1) shown_ = snapshots_.back()->time;
}

double SlowMotion::wanted(double wall) const {
  const Snapshot& newest = *snapshots_.back();
  const double lag = 1 / rate_of(newest) + allowance;
  const double time = newest.time + (wall - newest.due_at - lag) * newest.speed;
  return std::clamp(std::max(time, shown_), snapshots_.front()->time, newest.time);
}

SlowMotion::Shown SlowMotion::at(double wall) {
  const Snapshot& newest = *snapshots_.back();
  if (snapshots_.size() < 2 || !is_slow(newest)) {
    shown_ = newest.time;
    if (newest.positions.device())
      return {.time = newest.time, .positions = {}, .device = newest.positions.device(), .telemetry = newest.telemetry};
    return {.time = newest.time, .positions = newest.positions.host(), .telemetry = newest.telemetry};
  }
  shown_ = wanted(wall);
  std::size_t next = 1;
  while (next + 1 < snapshots_.size() && snapshots_[next]->time < shown_) ++next;
  const Snapshot &a = *snapshots_[next - 1], &b = *snapshots_[next];
  const auto share = static_cast<float>(std::clamp((shown_ - a.time) / (b.time - a.time), 0.0, 1.0));
  const std::span<const Vec3> from = a.positions.host(), to = b.positions.host();
  positions_.resize(to.size());
  for (std::size_t i = 0; i < positions_.size(); ++i) positions_[i] = between(from[i], to[i], share);
  telemetry_ = newest.telemetry;
  for (std::size_t i = 0; i < telemetry_.size(); ++i)
    telemetry_[i].center_of_mass = between(a.telemetry[i].center_of_mass, b.telemetry[i].center_of_mass, share);
  return {.time = shown_, .positions = positions_, .telemetry = telemetry_};
}

}  // namespace mercury
