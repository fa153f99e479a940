// SPDX-License-Identifier: Apache-2.0
// The trial of a portion of robots: they settle, they are stepped and sampled, and their results are read.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "mercury/evaluator.h"
#include "mercury/simulation.h"
#include "sim/evaluator_clock.h"
#include "sim/evaluator_measures.h"
#include "sim/evaluator_portion.h"

namespace mercury {

// Puts the portion's robots into the simulation, in place of those it has, at time 0. Robots that break a rule stay
// outside and get the reason as their failure.
void load(Simulation& simulation, Portion& portion);

// What a trial asks and reports while it runs.
struct TrialContext {
  std::function<bool()> cancelled;                        // nobody wants its results any more
  std::function<bool()> stopping;                         // it ends early, with results
  std::function<void(std::int64_t robot_steps)> stepped;  // after each call of step()
  UnionClock* device_stepping = nullptr;                  // of this device
  UnionClock* stepping = nullptr;                         // of all devices
};

// Work per call of step(), so that a call takes a tenth of a second on the CPU and a third on a GPU. It adapts to the
// device from call to call, and a worker keeps it from trial to trial.
struct StepPace {
  explicit StepPace(bool on_gpu) : springs_and_masses(on_gpu ? 2e9 : 2e7) {}
  double springs_and_masses;
};

class Trial {
 public:
  Trial(Simulation& simulation, const EvaluationRequest& request, const TrialContext& context, StepPace& pace);

  // Returns false if the trial was cancelled.
  bool run();
  // One per candidate of the portion that was loaded.
  std::vector<Evaluation> results(const Portion& portion) const;

 private:
  bool advance(std::int64_t steps, std::int64_t sample_every);
  void step(std::int64_t steps);
  void step_and_observe(std::int64_t steps, std::int64_t sample_every);
  template <class Call>
  void timed(std::int64_t steps, Call call);
  // [sample][robot], `steps` steps apart; the first comes as many after the last sample before.
  void observe(std::span<const Telemetry> samples, std::int64_t steps);
  std::int64_t steps_per_call() const;

  Simulation& simulation_;
  const EvaluationRequest& request_;
  const TrialContext& context_;
  StepPace& pace_;
  double size_ = 1;  // springs and masses of all robots
  std::vector<TrialMeasures> measures_;
  std::int64_t steps_ = 0;  // since the start of the trial
};

}  // namespace mercury
