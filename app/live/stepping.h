// SPDX-License-Identifier: Apache-2.0
// How many steps the physics thread makes, and when: keeps simulated time at a given speed relative to wall time, in
// slices that leave time for commands and frames.
#pragma once

#include <cstdint>
#include <deque>

#include "app/live/live_batch.h"
#include "mercury/stopwatch.h"

namespace mercury {

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

// Whether robots play, how fast, and what a step of them costs. The physics thread owns it.
class Stepping {
 public:
  explicit Stepping(const LiveBatch& batch) : batch_(batch), cuda_device_(batch.simulation().cuda_device()) {}

  bool playing() const { return playing_; }
  bool is_unlimited() const;
  // The time of a scene without robots stands still.
  bool is_running() const { return playing_ && !batch_.empty(); }
  std::int64_t left() const { return left_; }            // steps to make while robots pause
  double step_seconds() const { return step_seconds_; }  // wall time of a step, a running mean; 0 = unknown [s]
  std::int64_t steps_in(double seconds) const;           // of wall time; at least 1

  void set_speed(double speed) { speed_ = speed; }
  void play(bool playing) { playing_ = playing; }
  void add(std::int64_t steps) { left_ += steps; }
  void drop() { left_ = 0; }
  void stop();  // for an explosion, a failure, or the end of a recording

  // Begins to count at the current moment: after a jump in time, or when speed or time step changed.
  void start();
  void follow_time_step();  // starts if that changed
  // Wall time at which the next steps are due [s]. `watched`: the window waits for a view.
  double next_due(bool watched) const;
  bool interrupts_device() const { return cuda_device_ >= 0 && is_running() && !is_unlimited(); }
  // How many steps are due; 0 if it is too early.
  std::int64_t due(bool watched);
  std::int64_t slice() const;     // as many steps as may be made before the next look at the commands
  void done(std::int64_t steps);  // of those that were due, or of a recording
  // Steps took this wall time in all, and samples of their telemetry that long [s]. Returns whether samples take too
  // much of the time.
  bool took(std::int64_t steps, double stepping, double measuring);
  void forget_cost() { step_seconds_ = 0; }  // of a step: the robots are others

  // At unlimited speed, snapshots may take at most a twentieth of the time.
  bool may_publish() const;
  void describe(Snapshot& next) const;  // who plays, and how fast
  double published(double started);     // returns how long it took, of wall time [s]

 private:
  std::int64_t at_once() const;

  const LiveBatch& batch_;
  const int cuda_device_;
  Pace pace_;
  SpeedGauge gauge_;
  bool playing_ = false;
  double speed_ = 1, dt_ = 0;
  std::int64_t left_ = 0;
  std::uint64_t stops_ = 0;
  double step_seconds_ = 0;
  double stepping_ = 0, measuring_ = 0;      // since samples were last limited [s]
  double published_at_ = 0, gathering_ = 0;  // end and duration of the last published() [s]
};

}  // namespace mercury
