// SPDX-License-Identifier: Apache-2.0
// How many steps are due: keeps simulated time at a given speed relative to wall time.
#pragma once

#include <cstdint>
#include <deque>

namespace mercury {

// Wall time [s] from an arbitrary origin; never goes back.
double wall_now();

// If physics is too slow, it falls behind for good: delays of more than a tenth of a second are forgotten, so that no
// backlog of steps builds up.
class Pace {
 public:
  // Starts at this wall time [s]. `speed` > 0 in simulated seconds per second, infinity = as fast as possible; `dt` is
  // the time step [s].
  void start(double wall, double speed, double dt);

  // Steps that are due at `wall` and not done. A very large number if the speed is infinite.
  std::int64_t due(double wall);
  // Wall time at which the last of that many next steps is due [s].
  double next_due(std::int64_t steps = 1) const;
  // Wall time at which the last completed step was due [s].
  double done_at() const { return start_ + static_cast<double>(done_) / rate_; }
  void done(std::int64_t steps) { done_ += steps; }

 private:
  static constexpr double most_late = 0.1;  // [s]
  double start_ = 0, rate_ = 1;             // wall time [s]; steps per second
  std::int64_t done_ = 0;
};

// Measures simulated seconds per second over about the last second.
class SpeedGauge {
 public:
  void clear() { marks_.clear(); }
  void mark(double wall, double time);
  double speed() const;

 private:
  struct Mark {
    double wall, time;
  };
  std::deque<Mark> marks_;
};

}  // namespace mercury
