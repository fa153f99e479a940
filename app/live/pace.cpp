// SPDX-License-Identifier: Apache-2.0
#include "app/live/pace.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>

namespace mercury {

double wall_now() { return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count(); }

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

}  // namespace mercury
