// SPDX-License-Identifier: Apache-2.0
// The trial of a portion of robots: they settle, they are stepped and sampled, and their results are read.
#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <mutex>
#include <span>
#include <vector>

#include "mercury/evaluator.h"
#include "mercury/simulation.h"
#include "mercury/trial_measures.h"
#include "sim/evaluator_portion.h"

namespace mercury {

// How long something goes on, on one or more threads: the time during which at least one interval was open: the union
// of the intervals.
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

// Puts the portion's robots into the simulation, in place of those it has, at time 0. Robots that break a rule stay
// outside and get the reason as their failure.
void load(Simulation& simulation, Portion& portion);

// What a trial asks and reports while it runs.
struct TrialContext {
  std::function<bool()> canceled;                         // nobody wants its results any more
  std::function<bool()> stopping;                         // it ends early, with results
  std::function<void(std::int64_t robot_steps)> stepped;  // after each call of step()
  std::function<void(std::int64_t steps)> sampled;        // steps of the trial at its last sample
  UnionClock* device_stepping = nullptr;                  // of this device
  UnionClock* stepping = nullptr;                         // of all devices
};

// Work per call of step(), so that a call takes a tenth of a second on the CPU and a third on a GPU. It adapts to the
// device from call to call, and a worker keeps it from trial to trial.
struct StepPace {
  explicit StepPace(bool on_gpu) : springs_and_masses(on_gpu ? 1e10 : 2e7) {}
  double springs_and_masses;
};

// A robot leaves the simulation at the check that removes it, so robots of the simulation are counted by themselves:
//
//   candidates         0   1   2   3   4   5       of the portion; results_ has one element for each
//   loaded             0   .   1   2   3   4       candidate 1 cannot be used
//   after a check      0   .   .   1   .   2       candidates 2 and 4 were removed: their results are complete
//
class PortionTrial {
 public:
  // `portion` was loaded into the simulation.
  PortionTrial(Simulation& simulation, const EvaluationRequest& request, const TrialContext& context, StepPace& pace,
               const Portion& portion);

  // Returns false if the trial was canceled.
  bool run();
  // One per candidate. Takes them out of the trial.
  std::vector<Evaluation> results();

 private:
  void place();
  // Writes the drives of a period that begins now. Returns in how many steps the next one begins.
  std::int64_t drive();
  bool settle();
  bool advance(std::int64_t end);
  void step(std::int64_t steps);
  void step_and_observe(std::int64_t steps);
  template <class Call>
  void timed(std::int64_t steps, Call call);
  void observe_now();
  // [sample][robot], `steps` steps apart; the first comes as many after the last sample before. The first of all is the
  // start of the trial.
  void observe(std::span<const Telemetry> samples, std::int64_t steps);
  void remove_losers();
  void keep(std::span<const std::size_t> robots);
  std::int64_t steps_per_call() const;
  std::int64_t steps_done() const { return simulation_.steps() - settled_; }
  double seconds(std::int64_t steps) const;

  Simulation& simulation_;
  const EvaluationRequest& request_;
  const TrialContext& context_;
  StepPace& pace_;
  const std::int64_t sample_every_;
  double size_ = 1;  // springs and masses of all robots
  std::vector<Evaluation> results_;
  // Per robot of the simulation.
  std::vector<std::size_t> candidates_;
  std::vector<TrialMeasures> measures_;
  std::vector<std::size_t> actuator_counts_;  // if they are driven
  std::int64_t settled_ = 0;                  // steps of the simulation at the start of the trial
  std::int64_t observed_ = 0;                 // steps of the trial at the last sample
};

}  // namespace mercury
