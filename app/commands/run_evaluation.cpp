// SPDX-License-Identifier: Apache-2.0
#include "app/commands/run_evaluation.h"

#include <fmt/format.h>

#include <algorithm>
#include <optional>
#include <utility>

#include "app/base/messages.h"
#include "app/base/progress.h"
#include "app/base/stepping.h"
#include "app/commands/evaluation_results.h"
#include "mercury/clock.h"
#include "mercury/error.h"
#include "mercury/evaluator.h"
#include "mercury/host_memory.h"
#include "mercury/parallel.h"
#include "mercury/trial_measures.h"

namespace mercury {
namespace {

// The recorder, unless there is none or a write failed.
Recorder* working_recorder(const StepObservers& observers) {
  return observers.recorder && !observers.recorder->failed() ? observers.recorder : nullptr;
}

// Steps a simulation to a step, with those who take part. Returns false once the user interrupts.
class Advance {
 public:
  // `stride` = steps between two looks at the time for a checkpoint.
  Advance(Simulation& simulation, const StepObservers& observers, const TrialProgress& trial, std::int64_t end,
          std::int64_t stride)
      : simulation_(simulation), observers_(observers), trial_(trial), stepper_(simulation), first_(simulation.steps()),
        stride_(stride), progress_("simulating", "steps", end - first_) {}

  bool to(std::int64_t target) {
    ReproChanges* const changes = observers_.changes;
    Checkpoints* const checkpoints = observers_.checkpoints;
    while (simulation_.steps() < target) {
      Recorder* recorder = working_recorder(observers_);
      if (changes) changes->apply(simulation_);
      std::int64_t stop = changes ? std::min(target, changes->next_step()) : target;
      if (recorder) stop = std::min(stop, recorder->next_step());
      if (checkpoints) stop = std::min(stop, simulation_.steps() + stride_);
      const bool goes_on = stepper_.advance_to(stop);
      if (recorder) observe(*recorder);  // also on the way out: a frame between two steps needs both
      if (!goes_on) return false;
      if (checkpoints && checkpoints->due()) checkpoints->write(simulation_, trial_, working_recorder(observers_));
      progress_.update(simulation_.steps() - first_);
    }
    return true;
  }

  double wall_seconds() const { return stepper_.wall_seconds(); }

 private:
  // The run may have taken hours: it goes on.
  static void observe(Recorder& recorder) {
    try {
      recorder.observe();
    } catch (const RecordingFailure& failure) {
      warn_without_recording(failure);
    }
  }

  Simulation& simulation_;
  const StepObservers observers_;
  const TrialProgress& trial_;
  Stepper stepper_;
  const std::int64_t first_, stride_;
  Progress progress_;
};

// What an Evaluator would yield for each robot of a simulation after these steps of the trial.
std::vector<Evaluation> evaluations_of(const Simulation& simulation, std::span<const TrialMeasures> measures,
                                       std::int64_t steps) {
  const std::vector<std::uint64_t> hashes = simulation.hashes();
  std::vector<Evaluation> evaluations(measures.size());
  for (std::size_t i = 0; i < evaluations.size(); ++i) {
    Evaluation& evaluation = evaluations[i];
    evaluation.index = i;
    evaluation.robot = {std::shared_ptr<const Robot>(), &simulation.robot(i)};  // the simulation owns it
    evaluation.steps = steps;
    evaluation.hash = hashes[i];
    measures[i].write(evaluation);
  }
  return evaluations;
}

void report_failure(const RobotResult& robot) {
  const auto& [index, name, file, random] = robot.identity;
  warn(fmt::format("{} was left out: {}", file.empty() ? name : file, robot.failure));
}

// Names robots that could not be made. Throws InputError if they are all robots of a request.
void report_failures(const RobotSequence& robots, std::span<const RobotResult> results) {
  std::vector<const RobotResult*> failed;
  for (const RobotResult& robot : results)
    if (!robot.was_stepped()) failed.push_back(&robot);
  std::size_t first = robots.count;
  for (std::size_t i = robots.random.size(); i-- > 0;) {
    const std::size_t end = std::exchange(first, first - robots.random[i].count);
    const auto is_of_request = [&](const RobotResult* robot) {
      return robot->identity.index >= first && robot->identity.index < end;
    };
    if (static_cast<std::size_t>(std::ranges::count_if(failed, is_of_request)) == end - first)
      throw InputError("--random", "none could be grown: " + (*std::ranges::find_if(failed, is_of_request))->failure);
  }
  for (const RobotResult* robot : failed) report_failure(*robot);
}

// A trial that began at step `first` and has come to `trial`. A sample that is not complete at the end counts for the
// results, but not for the last checkpoint: a run that goes on from there completes it.
RunReport measure(Simulation& simulation, std::vector<RobotIdentity> identities, const TrialSettings& trials,
                  const StepObservers& observers, std::int64_t first, TrialProgress trial) {
  const EvaluationRequest request = trial_request(trials, simulation.configuration());
  simulation.measure_folding(request.folding);
  simulation.measure_upright(request.upright);
  const std::int64_t start = first + request.settling, end = start + request.steps;
  Advance advance(simulation, observers, trial, end, request.sample_every);
  RunReport report{.settle = trials.settle,
                   .jitter = trials.jitter,
                   .resumed = simulation.steps(),
                   .interrupted = trial.sampled < 0 && !advance.to(start)};
  if (trial.sampled < 0 && !report.interrupted) {
    for (const Telemetry& telemetry : simulation.telemetry())
      trial.measures.emplace_back(telemetry, simulation.configuration().environment);
    trial.sampled = simulation.steps();
  }
  const auto add_sample = [&] {
    const double seconds = simulation.configuration().dt * static_cast<double>(simulation.steps() - trial.sampled);
    const std::vector<Telemetry> now = simulation.telemetry();
    if (seconds > 0)
      for (std::size_t i = 0; i < now.size(); ++i) trial.measures[i].add(now[i], seconds);
    trial.sampled = simulation.steps();
  };
  while (!report.interrupted && simulation.steps() < end) {
    const std::int64_t next = trial.sampled + request.sample_every;
    report.interrupted = !advance.to(std::min(end, next));
    if (!report.interrupted && simulation.steps() == next) add_sample();
  }
  if (observers.checkpoints) observers.checkpoints->write(simulation, trial, working_recorder(observers));
  if (trial.sampled >= 0) {
    if (trial.sampled < simulation.steps()) add_sample();
    for (const Evaluation& robot : evaluations_of(simulation, trial.measures, simulation.steps() - start))
      report.robots.push_back(result_of(std::move(identities[robot.index]), std::span(&robot, 1), request, trials));
  }
  report.missing = simulation.size() - report.robots.size();
  report.configuration = simulation.configuration();
  report.device = simulation.device_name();
  report.steps = simulation.steps();
  report.seconds = simulation.time();
  report.wall_seconds = advance.wall_seconds();
  report.notes = simulation.notes();
  return report;
}

}  // namespace

void warn_without_recording(const RecordingFailure& failure) {
  warn(fmt::format("{}; the run goes on without a recording", failure.what()));
}

RobotIdentity identity_of(const RobotSequence& robots, std::size_t index) {
  if (index < robots.files.size()) return {.index = index, .name = "", .file = robots.files[index].string()};
  std::size_t first = robots.files.size();
  for (const RandomRobots& request : robots.random) {
    if (index < first + request.count) return identity_of(request, request.first + (index - first), index);
    first += request.count;
  }
  return {.index = index};
}

RunReport evaluate(const RobotSequence& robots, const Configuration& configuration, const TrialSettings& trials,
                   std::uint64_t seed, UnsavedResults& results) {
  const EvaluationRequest request = trial_request(trials, configuration, seed);
  const auto per_robot = static_cast<std::size_t>(trials.trials);
  Evaluator evaluator(request, trial_source(robots.source, trials, seed), robots.count * per_robot);
  RunReport report{
      .configuration = configuration, .settle = trials.settle, .trials = trials.trials, .jitter = trials.jitter};
  std::optional<std::int64_t> reached;  // steps of the trial
  std::vector<Evaluation> of_robot;     // those of its trials that have come so far
  // Of robots all of whose trials have come. Their results are worked out on all cores, many at a time: the last robots
  // of a device come at once, and the origin of each is parsed.
  constexpr std::size_t most_waiting = 512;
  std::vector<std::vector<Evaluation>> waiting;
  const auto work_out = [&] {
    const std::size_t first = report.robots.size();
    report.robots.resize(first + waiting.size());
    parallel_for(0, waiting.size(), [&](std::size_t i) {
      const std::vector<Evaluation> own = std::move(waiting[i]);
      report.robots[first + i] = result_of(identity_of(robots, own.front().index / per_robot), own, request, trials);
    });
    waiting.clear();
  };
  const auto take = [&](const Evaluation& trial) {
    const std::size_t robot = trial.index / per_robot;
    if (!of_robot.empty() && of_robot.front().index / per_robot != robot) of_robot.clear();
    if (trial.failure.empty()) {
      const bool has_settled = trial.steps > 0 || request.settling == 0 || request.steps == 0;
      if (!has_settled || (reached && trial.steps != *reached)) return;
      reached = trial.steps;
    }
    of_robot.push_back(trial);
    if (of_robot.size() < per_robot) return;
    waiting.push_back(std::exchange(of_robot, {}));
    if (waiting.size() == most_waiting) work_out();
  };
  bool stopped = false;
  {
    Progress progress("simulating", trials.trials > 1 ? "trials" : "robots",
                      static_cast<std::int64_t>(robots.count * per_robot));
    try {
      stopped = !take_results(evaluator, progress, request.settling + request.steps, results, take);
    } catch (const DeviceError& error) {
      work_out();
      if (report.robots.empty()) throw;
      report.problem = error.what();
      stopped = true;
    }
  }
  work_out();
  report.missing = robots.count - report.robots.size();
  report.interrupted = stopped && (report.missing > 0 || reached.value_or(0) < request.steps);
  if (!report.interrupted) report_failures(robots, report.robots);
  report.steps = reached ? request.settling + *reached : 0;
  report.seconds = time_of({.dt = configuration.dt, .step = report.steps});
  report.device = evaluator.device_name();
  report.notes = evaluator.notes();
  report.wall_seconds = evaluator.progress().stepping;
  return report;
}

RunReport simulate(Simulation& simulation, std::vector<RobotIdentity> identities, const TrialSettings& trials,
                   const StepObservers& observers) {
  return measure(simulation, std::move(identities), trials, observers, simulation.steps(), {});
}

RunReport resume(Simulation& simulation, std::vector<RobotIdentity> identities, const TrialSettings& trials,
                 const StepObservers& observers, TrialProgress progress) {
  return measure(simulation, std::move(identities), trials, observers, 0, std::move(progress));
}

GatheredRobots gather(const RobotSequence& robots) {
  require_memory_for(robots.random, recorded_memory, usable_host_memory());
  constexpr std::size_t portion = 512;
  std::vector<std::shared_ptr<const Robot>> made(robots.count);
  std::vector<std::string> failures(robots.count);
  {
    Progress progress("making", "robots", static_cast<std::int64_t>(robots.count));
    for (std::size_t first = 0; first < robots.count; first += portion) {
      throw_if_interrupted();
      progress.update(static_cast<std::int64_t>(first));
      parallel_for(first, std::min(first + portion, robots.count), [&](std::size_t i) {
        try {
          made[i] = robots.source(i);
        } catch (const InputError& error) {
          failures[i] = error.what();
        }
      });
    }
  }
  GatheredRobots gathered;
  for (std::size_t i = 0; i < robots.count; ++i) {
    if (made[i]) {
      gathered.robots.push_back(std::move(made[i]));
      gathered.identities.push_back(identity_of(robots, i));
    } else {
      gathered.failed.push_back({.identity = identity_of(robots, i), .failure = failures[i]});
    }
  }
  report_failures(robots, gathered.failed);
  return gathered;
}

void add_failed(RunReport& report, std::vector<RobotResult> failed) {
  std::ranges::move(failed, std::back_inserter(report.robots));
  std::ranges::sort(report.robots, {}, [](const RobotResult& robot) { return robot.identity.index; });
}

}  // namespace mercury
