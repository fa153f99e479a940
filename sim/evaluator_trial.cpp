// SPDX-License-Identifier: Apache-2.0
#include "sim/evaluator_trial.h"

#include <oneapi/tbb/parallel_for.h>

#include <algorithm>
#include <chrono>

#include "mercury/error.h"

namespace mercury {
namespace {

// Of a call of step() [s]. On a GPU each call ends with some robots stepping alone, so calls are longer there.
constexpr double cpu_call = 0.1, cuda_call = 0.3;
constexpr std::size_t most_samples = 1u << 19;  // of all robots in a call

}  // namespace

void load(Simulation& simulation, Portion& portion) {
  simulation.keep({});
  simulation.reset();
  try {
    simulation.add(portion.robots());
    return;
  } catch (const InputError&) {
    // One or more break a rule. Below, each is validated by itself; most portions are spared that.
  }
  for (Candidate& candidate : portion.candidates) {
    if (!candidate.robot) continue;
    try {
      validate(*candidate.robot);
    } catch (const InputError& error) {
      candidate.failure = error.what();
    }
  }
  simulation.add(portion.robots());
}

Trial::Trial(Simulation& simulation, const EvaluationRequest& request, const TrialContext& context, StepPace& pace)
    : simulation_(simulation), request_(request), context_(context), pace_(pace) {
  for (std::size_t i = 0; i < simulation.size(); ++i)
    size_ += static_cast<double>(simulation.robot(i).springs.size() + simulation.robot(i).masses.size());
}

bool Trial::run() {
  if (simulation_.size() == 0) return true;
  if (!advance(request_.settling, 0)) return false;
  measures_.reserve(simulation_.size());
  for (const Telemetry& start : simulation_.telemetry()) measures_.emplace_back(start);
  const std::int64_t settled = simulation_.steps();
  const std::int64_t every = request_.sample_every > 0 ? request_.sample_every : request_.steps;
  if (!advance(request_.steps, every)) return false;
  steps_ = simulation_.steps() - settled;
  return true;
}

// Makes `steps` steps, or fewer if the evaluation stops. Observes every `sample_every` steps and at the end; 0 = never.
bool Trial::advance(std::int64_t steps, std::int64_t sample_every) {
  const std::int64_t first = simulation_.steps();
  std::int64_t done = 0, observed = 0;
  const bool observes = sample_every > 0;
  while (done < steps && !context_.stopping()) {
    if (context_.cancelled()) return false;
    const std::int64_t count = std::min(steps_per_call(), steps - done);
    if (observes && done == observed && count >= sample_every) {
      step_and_observe(count - count % sample_every, sample_every);
      done = observed = simulation_.steps() - first;
      continue;
    }
    const std::int64_t next = observes ? std::min(steps, observed + sample_every) : steps;
    step(std::min(count, next - done));
    done = simulation_.steps() - first;
    if (!observes || done < next) continue;
    observe(simulation_.telemetry(), done - observed);
    observed = done;
  }
  if (observes && observed < done) observe(simulation_.telemetry(), done - observed);
  return !context_.cancelled();
}

void Trial::step(std::int64_t steps) {
  timed(steps, [&] { simulation_.step(steps); });
}

void Trial::step_and_observe(std::int64_t steps, std::int64_t sample_every) {
  std::vector<Telemetry> samples;
  timed(steps, [&] { samples = simulation_.step_and_sample(steps, sample_every); });
  observe(samples, sample_every);
}

template <class Call>
void Trial::timed(std::int64_t steps, Call call) {
  const auto start = std::chrono::steady_clock::now();
  {
    const UnionClock::Interval all(*context_.stepping), device(*context_.device_stepping);
    call();
  }
  const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  const double wanted = simulation_.cuda_device() >= 0 ? cuda_call : cpu_call;
  const bool as_many_as_allowed = 2 * steps > steps_per_call();
  if (seconds > wanted || as_many_as_allowed)
    pace_.springs_and_masses =
        std::max(size_, static_cast<double>(steps) * size_ * std::clamp(wanted / seconds, 0.5, 8.0));
  context_.stepped(steps * static_cast<std::int64_t>(simulation_.size()));
}

std::int64_t Trial::steps_per_call() const {
  const std::size_t samples = std::max<std::size_t>(1, most_samples / simulation_.size());
  const double most = request_.sample_every > 0 ? static_cast<double>(samples * request_.sample_every) : 1e15;
  return static_cast<std::int64_t>(std::clamp(pace_.springs_and_masses / size_, 1.0, most));
}

void Trial::observe(std::span<const Telemetry> samples, std::int64_t steps) {
  const double seconds = simulation_.configuration().dt * static_cast<double>(steps);
  const std::size_t robots = measures_.size();
  oneapi::tbb::parallel_for(std::size_t{0}, robots, [&](std::size_t i) {
    for (std::size_t at = i; at < samples.size(); at += robots) measures_[i].add(samples[at], seconds);
  });
}

std::vector<Evaluation> Trial::results(const Portion& portion) const {
  std::vector<std::uint64_t> hashes;
  if (request_.hashes) hashes = simulation_.hashes();
  std::vector<Evaluation> results;
  results.reserve(portion.candidates.size());
  std::size_t i = 0;  // in the simulation
  for (const Candidate& candidate : portion.candidates) {
    Evaluation& result = results.emplace_back();
    result.index = portion.first + results.size() - 1;
    result.robot = candidate.robot;
    result.failure = candidate.failure;
    if (!candidate.failure.empty()) continue;
    result.steps = steps_;
    measures_[i].write(result);
    if (request_.hashes) result.hash = hashes[i];
    if (request_.states) result.state = simulation_.state(i);
    ++i;
  }
  return results;
}

}  // namespace mercury
