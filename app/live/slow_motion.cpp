// SPDX-License-Identifier: Apache-2.0
#include "app/live/slow_motion.h"

#include <algorithm>
#include <cmath>

namespace mercury {
namespace {

constexpr std::size_t most_moments = 5;

Vec3 between(Vec3 a, Vec3 b, float share) { return a + share * (b - a); }

// Steps a second of wall time; 0 = none or no one knows.
double rate_of(const Moment& moment) {
  return moment.playing && std::isfinite(moment.speed) ? moment.speed / moment.configuration.dt : 0;
}

bool is_slow(const Moment& moment) {
  const double rate = rate_of(moment);
  return rate > 0 && rate <= SlowMotion::most_rate;
}

}  // namespace

void SlowMotion::take(std::shared_ptr<const Moment> moment) {
  if (!moments_.empty()) {
    const Moment& last = *moments_.back();
    const bool other = last.robots->revision != moment->robots->revision || last.resets != moment->resets ||
                       moment->steps < last.steps;
    if (other || !is_slow(*moment))
      moments_.clear();
    else if (last.steps == moment->steps)
      moments_.pop_back();
  }
  moments_.push_back(std::move(moment));
  if (moments_.size() > most_moments) moments_.pop_front();
  if (moments_.size() == 1) shown_ = moments_.back()->time;
}

double SlowMotion::wanted(double wall) const {
  const Moment& newest = *moments_.back();
  const double lag = 1 / rate_of(newest) + allowance;
  const double time = newest.time + (wall - newest.due_at - lag) * newest.speed;
  return std::clamp(std::max(time, shown_), moments_.front()->time, newest.time);
}

SlowMotion::Shown SlowMotion::at(double wall) {
  const Moment& newest = *moments_.back();
  if (moments_.size() < 2 || !is_slow(newest)) {
    shown_ = newest.time;
    return {newest.time, newest.positions, newest.telemetry};
  }
  shown_ = wanted(wall);
  std::size_t next = 1;
  while (next + 1 < moments_.size() && moments_[next]->time < shown_) ++next;
  const Moment &a = *moments_[next - 1], &b = *moments_[next];
  const auto share = static_cast<float>(std::clamp((shown_ - a.time) / (b.time - a.time), 0.0, 1.0));
  positions_.resize(b.positions.size());
  for (std::size_t i = 0; i < positions_.size(); ++i) positions_[i] = between(a.positions[i], b.positions[i], share);
  telemetry_ = newest.telemetry;
  for (std::size_t i = 0; i < telemetry_.size(); ++i)
    telemetry_[i].center_of_mass = between(a.telemetry[i].center_of_mass, b.telemetry[i].center_of_mass, share);
  return {shown_, positions_, telemetry_};
}

}  // namespace mercury
