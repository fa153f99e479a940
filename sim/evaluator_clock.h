// SPDX-License-Identifier: Apache-2.0
// How long something was going on, on one or more threads.
#pragma once

#include <chrono>
#include <mutex>

namespace mercury {

// The time during which at least one interval was open: the union of the intervals.
class UnionClock {
 public:
  // An interval: open as long as it lives.
  class Interval {
   public:
    explicit Interval(UnionClock& clock) : clock_(clock) { clock_.change(+1); }
    ~Interval() { clock_.change(-1); }
    Interval(const Interval&) = delete;
    Interval& operator=(const Interval&) = delete;

   private:
    UnionClock& clock_;
  };

  // So far, the open interval included [s].
  double seconds() const {
    const std::lock_guard lock(mutex_);
    return std::chrono::duration<double>(open_ > 0 ? total_ + (Clock::now() - since_) : total_).count();
  }

 private:
  using Clock = std::chrono::steady_clock;

  void change(int by) {
    const std::lock_guard lock(mutex_);
    const Clock::time_point now = Clock::now();
    if (open_ > 0) total_ += now - since_;
    since_ = now;
    open_ += by;
  }

  mutable std::mutex mutex_;
  int open_ = 0;
  Clock::time_point since_;  // the last change
  Clock::duration total_{};
};

}  // namespace mercury
