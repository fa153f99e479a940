// SPDX-License-Identifier: Apache-2.0
// How many steps are due: simulated time against the clock on the wall.
#pragma once

#include <cstdint>
#include <deque>

namespace mercury {

// Wall time [s], from some beginning on.
double wall_now();

// Keeps simulated time at `speed` times real time. Where physics is too slow it falls behind for good rather than
// piling up work: what is more than a tenth of a second late is forgotten.
class Pace {
 public:
  // From here on, at this wall time [s]. `speed` > 0, infinity = as fast as it goes; dt [s].
  void start(double wall, double speed, double dt);

  // Steps that are due now and not done; a very large number as fast as it goes.
  std::int64_t due(double wall);
  // When the next step is due [s of wall time].
  double next_due() const;
  // When the last step done was due.
  double done_at() const { return start_ + static_cast<double>(done_) / rate_; }
  void done(std::int64_t steps) { done_ += steps; }

 private:
  static constexpr double most_late = 0.1;  // [s]
  double start_ = 0, rate_ = 1;             // wall time [s]; steps a second
  std::int64_t done_ = 0;
};

// Simulated seconds a second, over about the last second.
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
