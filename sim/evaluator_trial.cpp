// SPDX-License-Identifier: Apache-2.0
#include "sim/evaluator_trial.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "mercury/error.h"
#include "mercury/parallel.h"
#include "mercury/stopwatch.h"

namespace mercury {
namespace {

// Of a call of step() [s]. On a GPU each call ends with some robots stepping alone, so calls are longer there.
constexpr double cpu_call = 0.1, cuda_call = 0.3;

double size_of(const Robot& robot) { return static_cast<double>(robot.springs.size() + robot.masses.size()); }

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

PortionTrial::PortionTrial(Simulation& simulation, const EvaluationRequest& request, const TrialContext& context,
                           StepPace& pace, const Portion& portion)
    : simulation_(simulation), request_(request), context_(context), pace_(pace),
      sample_every_(request.sample_every > 0 ? request.sample_every : request.steps) {
  results_.reserve(portion.candidates.size());
  for (const Candidate& candidate : portion.candidates) {
    if (candidate.failure.empty()) candidates_.push_back(results_.size());
    results_.push_back(
        {.index = portion.first + results_.size(), .robot = candidate.robot, .failure = candidate.failure});
  }
  for (std::size_t i = 0; i < simulation.size(); ++i) {
    size_ += size_of(simulation.robot(i));
    if (request.drive) actuator_counts_.push_back(actuators_of(simulation.robot(i)).size());
  }
}

bool PortionTrial::run() {
  if (simulation_.size() == 0) return true;
  simulation_.measure_folding(request_.folding);
  simulation_.measure_upright(request_.upright);
  if (request_.start) place();
  if (request_.noise_seed && simulation_.has_brains())
    for (std::size_t i = 0; i < simulation_.size(); ++i)
      simulation_.set_noise_seed(i, request_.noise_seed(results_[candidates_[i]].index));
  if (!settle()) return false;
  settled_ = simulation_.steps();
  if (request_.drive) observe_now();  // before the first drives
  for (const std::int64_t check : request_.checks) {
    if (!advance(check)) return false;
    if (steps_done() < check) break;  // it stops, or no robot is left
    remove_losers();
  }
  if (!advance(request_.steps)) return false;
  if (simulation_.size() > 0 && (measures_.empty() || observed_ < steps_done())) observe_now();
  return true;
}

// Puts the masses where the request wants them.
void PortionTrial::place() {
  std::vector<Vec3> positions(simulation_.mass_count());
  parallel_for(0, simulation_.size(), [&](std::size_t i) {
    const std::vector<Vec3>& rest = simulation_.robot(i).masses;
    const std::span<Vec3> own = std::span(positions).subspan(simulation_.mass_offsets()[i], rest.size());
    std::ranges::copy(rest, own.begin());
    request_.start(results_[candidates_[i]].index, simulation_.robot(i), own);
  });
  simulation_.reset_to(positions);
}

std::int64_t PortionTrial::drive() {
  if (!request_.drive) return std::numeric_limits<std::int64_t>::max();
  const std::int64_t since = simulation_.steps() % request_.drive_every;
  if (since > 0) return request_.drive_every - since;
  std::vector<std::vector<float>> drives(simulation_.size());
  parallel_for(0, simulation_.size(), [&](std::size_t i) {
    drives[i].resize(actuator_counts_[i], std::numeric_limits<float>::quiet_NaN());
    request_.drive(results_[candidates_[i]].index, simulation_.robot(i), simulation_.steps() / request_.drive_every,
                   drives[i]);
  });
  std::vector<HeldDrive> held;
  for (std::size_t i = 0; i < drives.size(); ++i)
    for (std::size_t a = 0; a < drives[i].size(); ++a)
      if (!std::isnan(drives[i][a])) held.push_back({.robot = i, .actuator = a, .drive = drives[i][a]});
  simulation_.hold_drives(held);
  return request_.drive_every;
}

// Makes the steps before the start, or fewer if the evaluation stops.
bool PortionTrial::settle() {
  while (simulation_.steps() < request_.settling && !context_.stopping()) {
    if (context_.canceled()) return false;
    step(std::min({drive(), steps_per_call(), request_.settling - simulation_.steps()}));
  }
  return !context_.canceled();
}

// Goes on to this step of the trial, or not so far if the evaluation stops. Takes the samples on the way.
bool PortionTrial::advance(std::int64_t end) {
  while (simulation_.size() > 0 && steps_done() < end && !context_.stopping()) {
    if (context_.canceled()) return false;
    const std::int64_t count = std::min({drive(), steps_per_call(), end - steps_done()});
    const std::int64_t next = observed_ + sample_every_;
    if (steps_done() == observed_ && count >= sample_every_) {
      step_and_observe(count - count % sample_every_);
    } else {
      if (measures_.empty()) observe_now();
      step(std::min(count, next - steps_done()));
      if (steps_done() == next) observe_now();
    }
  }
  return !context_.canceled();
}

void PortionTrial::step(std::int64_t steps) {
  timed(steps, [&] { simulation_.step(steps); });
}

void PortionTrial::step_and_observe(std::int64_t steps) {
  timed(steps, [&] {
    const auto visit = [&](std::span<const Telemetry> samples) { observe(samples, sample_every_); };
    simulation_.step_and_sample(steps, sample_every_, visit, measures_.empty());
  });
}

template <class Call>
void PortionTrial::timed(std::int64_t steps, Call call) {
  const double start = wall_now();
  {
    const UnionClock::Interval all(*context_.stepping), device(*context_.device_stepping);
    call();
  }
  const double elapsed = wall_now() - start;
  const double wanted = simulation_.cuda_device() >= 0 ? cuda_call : cpu_call;
  const bool as_many_as_allowed = 2 * steps > steps_per_call();
  if (elapsed > wanted || as_many_as_allowed)
    pace_.springs_and_masses =
        std::max(size_, static_cast<double>(steps) * size_ * std::clamp(wanted / elapsed, 0.5, 8.0));
  context_.stepped(steps * static_cast<std::int64_t>(simulation_.size()));
}

std::int64_t PortionTrial::steps_per_call() const {
  return static_cast<std::int64_t>(std::clamp(pace_.springs_and_masses / size_, 1.0, 1e15));
}

double PortionTrial::seconds(std::int64_t steps) const {
  return simulation_.configuration().dt * static_cast<double>(steps);
}

void PortionTrial::observe_now() { observe(simulation_.telemetry(), steps_done() - observed_); }

void PortionTrial::observe(std::span<const Telemetry> samples, std::int64_t steps) {
  const std::size_t robots = candidates_.size();
  if (measures_.empty()) {
    measures_.reserve(robots);
    for (const Telemetry& start : samples.first(robots))
      measures_.emplace_back(start, request_.configuration.environment);
    samples = samples.subspan(robots);
  }
  parallel_for(0, robots, [&](std::size_t i) {
    for (std::size_t at = i; at < samples.size(); at += robots) measures_[i].add(samples[at], seconds(steps));
  });
  observed_ += steps * static_cast<std::int64_t>(samples.size() / robots);
  context_.sampled(observed_);
}

// Asks about every robot. A check between two samples is a sample for the robots that it removes, and none for the
// others: their results must not depend on the checks.
void PortionTrial::remove_losers() {
  const std::size_t robots = simulation_.size();
  const std::int64_t now = steps_done();
  const bool is_sampled = observed_ == now;
  const std::vector<Telemetry> telemetry = is_sampled ? std::vector<Telemetry>() : simulation_.telemetry();
  std::vector<Evaluation> reached(robots);
  std::vector<std::uint8_t> goes_on(robots);
  parallel_for(0, robots, [&](std::size_t i) {
    TrialMeasures measures = measures_[i];
    if (!is_sampled) measures.add(telemetry[i], seconds(now - observed_));
    reached[i] = results_[candidates_[i]];
    reached[i].steps = now;
    measures.write(reached[i]);
    goes_on[i] = request_.goes_on(reached[i]) ? 1 : 0;
  });
  std::vector<std::size_t> kept;
  for (std::size_t i = 0; i < robots; ++i)
    if (goes_on[i] != 0) kept.push_back(i);
  if (kept.size() == robots) return;
  const std::vector<std::uint64_t> hashes = request_.hashes ? simulation_.hashes() : std::vector<std::uint64_t>();
  for (std::size_t i = 0; i < robots; ++i) {
    if (goes_on[i] != 0) continue;
    if (request_.hashes) reached[i].hash = hashes[i];
    if (request_.states) reached[i].state = simulation_.state(i);
    results_[candidates_[i]] = std::move(reached[i]);
  }
  context_.stepped((request_.steps - now) * static_cast<std::int64_t>(robots - kept.size()));
  keep(kept);
}

// By their current indices, ascending.
void PortionTrial::keep(std::span<const std::size_t> robots) {
  simulation_.keep(robots);
  size_ = 1;
  for (std::size_t i = 0; i < robots.size(); ++i) {
    candidates_[i] = candidates_[robots[i]];
    measures_[i] = measures_[robots[i]];
    if (request_.drive) actuator_counts_[i] = actuator_counts_[robots[i]];
    size_ += size_of(simulation_.robot(i));
  }
  candidates_.resize(robots.size());
  measures_.erase(measures_.begin() + static_cast<std::ptrdiff_t>(robots.size()), measures_.end());
}

std::vector<Evaluation> PortionTrial::results() {
  std::vector<std::uint64_t> hashes;
  if (request_.hashes) hashes = simulation_.hashes();
  for (std::size_t i = 0; i < simulation_.size(); ++i) {
    Evaluation& result = results_[candidates_[i]];
    result.steps = steps_done();
    measures_[i].write(result);
    if (request_.hashes) result.hash = hashes[i];
    if (request_.states) result.state = simulation_.state(i);
  }
  return std::move(results_);
}

}  // namespace mercury
