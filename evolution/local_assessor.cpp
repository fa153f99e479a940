// SPDX-License-Identifier: Apache-2.0
// Tries candidates on the devices of this process, by an Evaluator: it grows them while others are stepped.
#include <oneapi/tbb/parallel_for.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <memory>
#include <mutex>
#include <utility>

#include "evolution/trial_robot.h"
#include "mercury/assessor.h"
#include "mercury/error.h"
#include "mercury/evaluator.h"
#include "mercury/fnv.h"
#include "mercury/quantity.h"

namespace mercury {
namespace {

constexpr std::chrono::milliseconds watch_period(100);
constexpr std::size_t most_waiting = 128;  // evaluations

// The robots of all trials: those of candidate 0, then those of candidate 1, ... Each candidate is grown once.
class EvaluationQueue {
 public:
  EvaluationQueue(std::span<const GenomePointer> candidates, const TrialSettings& settings, std::uint64_t seed)
      : candidates_(candidates), settings_(settings), seed_(seed), grown_(candidates.size()) {}

  std::shared_ptr<const Robot> operator()(std::size_t index) {
    const auto trials = static_cast<std::size_t>(settings_.trials);
    const std::size_t i = index / trials;
    const std::shared_ptr<const Robot> robot = grown(i);
    if (trials_are_alike(settings_)) return robot;
    return std::make_shared<const Robot>(trial_robot(*robot, settings_, seed_, static_cast<int>(index % trials)));
  }

 private:
  struct Grown {
    std::mutex mutex;
    std::shared_ptr<const Robot> robot;
    int uses = 0;
  };

  std::shared_ptr<const Robot> grown(std::size_t i) {
    Grown& grown = grown_[i];
    const std::lock_guard lock(grown.mutex);
    if (!grown.robot) grown.robot = std::make_shared<const Robot>(candidates_[i]->grow("candidate"));
    return ++grown.uses == settings_.trials ? std::exchange(grown.robot, nullptr) : grown.robot;
  }

  const std::span<const GenomePointer> candidates_;
  const TrialSettings& settings_;
  const std::uint64_t seed_;
  std::vector<Grown> grown_;
};

// Adds the trials of one candidate up.
class Tally {
 public:
  Tally(const EvaluationRequest& request, const TrialSettings& settings, std::span<const Objective> objectives)
      : request_(request), settings_(settings), objectives_(objectives) {}

  void add(const Evaluation& evaluation) {
    assessment_.fate = worse(assessment_.fate, fate_of(evaluation, request_, settings_.strain_limit));
    ++trials_;
    if (!evaluation.failure.empty()) {
      if (assessment_.problem.empty()) assessment_.problem = evaluation.failure;
      return;
    }
    assessment_.hash = Fnv1a(assessment_.hash).add(evaluation.hash).value();
    const std::vector<double> values =
        quantities_of({.robot = *evaluation.robot, .evaluation = evaluation, .configuration = request_.configuration});
    values_.resize(values.size());
    for (std::size_t q = 0; q < values.size(); ++q) values_[q] += values[q];
    scores_.resize(objectives_.size());
    for (std::size_t o = 0; o < objectives_.size(); ++o) scores_[o] += objectives_[o].score(values);
  }

  Assessment result(std::vector<double> interim_scores) {
    const auto mean = [&](std::vector<double>& sums) {
      for (double& sum : sums) sum /= trials_;
    };
    mean(values_);
    mean(scores_);
    const bool counts = assessment_.fate == Fate::sound || assessment_.fate == Fate::stopped;
    if (!counts) scores_.assign(objectives_.size(), worst_score);
    if (assessment_.fate == Fate::failed) values_.clear();
    assessment_.values = std::move(values_);
    assessment_.scores = std::move(scores_);
    assessment_.interim_scores = std::move(interim_scores);
    return std::move(assessment_);
  }

 private:
  static Fate worse(Fate a, Fate b) { return std::max(a, b); }

  const EvaluationRequest& request_;
  const TrialSettings& settings_;
  const std::span<const Objective> objectives_;
  Assessment assessment_{.fate = Fate::sound, .hash = Fnv1a::empty};
  std::vector<double> values_, scores_;  // sums
  double trials_ = 0;
};

class LocalAssessor : public Assessor {
 public:
  LocalAssessor(const Configuration& configuration, const TrialSettings& settings, std::vector<Objective> objectives,
                std::uint64_t seed)
      : configuration_(configuration), settings_(settings), objectives_(std::move(objectives)), seed_(seed) {}

  std::optional<std::vector<Assessment>> assess(std::span<const GenomePointer> candidates,
                                                std::span<const double> interim_limits, const Watch& watch) override {
    const auto trials = static_cast<std::size_t>(settings_.trials);
    const std::size_t all = candidates.size() * trials;
    EvaluationQueue queue(candidates, settings_, seed_);
    EvaluationRequest request = trial_request(settings_, configuration_);
    std::vector<std::vector<double>> interim_scores(candidates.size());
    if (settings_.racing && request.steps > static_cast<std::int64_t>(racing_checks)) {
      for (std::size_t check = 1; check <= racing_checks; ++check)
        request.checks.push_back(request.steps * static_cast<std::int64_t>(check) /
                                 static_cast<std::int64_t>(racing_checks + 1));
      request.goes_on = [&](const Evaluation& so_far) {
        std::vector<double>& scores = interim_scores[so_far.index];  // one trial per candidate
        const std::size_t check = scores.size();
        scores.push_back(objectives_.front().score(
            quantities_of({.robot = *so_far.robot, .evaluation = so_far, .configuration = configuration_})));
        return interim_limits.empty() || scores[check] >= interim_limits[check];
      };
    }
    Evaluator evaluator(request, std::ref(queue), all);
    std::vector<Assessment> assessments(candidates.size());
    std::vector<Evaluation> waiting;  // of whole candidates; their quantities are computed on all cores
    std::size_t assessed = 0;
    const auto assess_waiting = [&] {
      oneapi::tbb::parallel_for(std::size_t{0}, waiting.size() / trials, [&](std::size_t k) {
        Tally tally(request, settings_, objectives_);
        for (std::size_t t = 0; t < trials; ++t) tally.add(waiting[k * trials + t]);
        assessments[assessed + k] = tally.result(std::move(interim_scores[assessed + k]));
      });
      assessed += waiting.size() / trials;
      waiting.clear();
    };
    for (std::size_t i = 0; i < candidates.size(); ++i) {
      for (std::size_t t = 0; t < trials; ++t) {
        while (!evaluator.wait_for(watch_period))
          if (watch && !watch(evaluator.progress().done, all)) return std::nullopt;
        waiting.push_back(evaluator.next().value());
      }
      if (waiting.size() < most_waiting) continue;
      assess_waiting();
      if (watch && !watch(evaluator.progress().done, all)) return std::nullopt;
    }
    assess_waiting();
    if (watch && !watch(all, all)) return std::nullopt;
    if (device_name_.empty()) device_name_ = evaluator.device_name();
    return assessments;
  }

  std::string device_name() const override { return device_name_; }

 private:
  const Configuration configuration_;
  const TrialSettings settings_;
  const std::vector<Objective> objectives_;
  const std::uint64_t seed_;
  std::string device_name_;
};

}  // namespace

EvaluationRequest trial_request(const TrialSettings& settings, const Configuration& configuration) {
  const auto steps_in = [&](double seconds) { return std::int64_t{std::llround(seconds / configuration.dt)}; };
  const std::int64_t settling = steps_in(settings.settle);
  return {.configuration = configuration,
          .settling = settling,
          .steps = steps_in(settings.seconds) - settling,
          .sample_every = std::max<std::int64_t>(1, steps_in(trial_sample_period)),
          .hashes = true};
}

Fate fate_of(const Evaluation& evaluation, const EvaluationRequest& request, double strain_limit) {
  if (!evaluation.failure.empty()) return Fate::failed;
  if (evaluation.end.exploded) return Fate::exploded;
  if (!(evaluation.largest_strain <= strain_limit)) return Fate::overstretched;
  return evaluation.steps < request.steps ? Fate::stopped : Fate::sound;
}

std::unique_ptr<Assessor> make_local_assessor(const Configuration& configuration, const TrialSettings& trials,
                                              std::vector<Objective> objectives, std::uint64_t seed) {
  return std::make_unique<LocalAssessor>(configuration, trials, std::move(objectives), seed);
}

}  // namespace mercury
