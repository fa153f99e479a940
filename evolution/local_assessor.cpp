// SPDX-License-Identifier: Apache-2.0
// Tries candidates on the devices of this process, by an Evaluator: it grows them while others are stepped.
#include <oneapi/tbb/parallel_for.h>

#include <algorithm>
#include <chrono>
#include <limits>
#include <memory>
#include <numeric>
#include <utility>

#include "mercury/assessor.h"
#include "mercury/evaluator.h"
#include "mercury/fnv.h"
#include "mercury/quantity.h"
#include "mercury/spread.h"
#include "mercury/trials.h"

namespace mercury {
namespace {

constexpr std::chrono::milliseconds watch_period(100);
constexpr std::size_t most_waiting = 128;  // evaluations

// The trials of one candidate together.
class Tally {
 public:
  Tally(const EvaluationRequest& request, const TrialSettings& settings, std::span<const Objective> objectives)
      : request_(request), settings_(settings), objectives_(objectives) {}

  void add(const Evaluation& evaluation) {
    const Fate fate = fate_of(evaluation, request_, settings_);
    assessment_.fate = worse(assessment_.fate, fate);
    // Runs of earlier versions do not rank robots by it.
    if (settings_.median)
      assessment_.violation = std::max(assessment_.violation, violation_of(evaluation, request_, settings_));
    ++trials_;
    if (!evaluation.failure.empty()) {
      if (assessment_.problem.empty()) assessment_.problem = evaluation.failure;
      return;
    }
    assessment_.hash = Fnv1a(assessment_.hash).add(evaluation.hash).value();
    // One trial has its own hash, as in `mercury run`, except in runs of earlier versions.
    if (settings_.median && settings_.trials == 1) assessment_.hash = evaluation.hash;
    const std::vector<double> values = quantities_of({.robot = *evaluation.robot,
                                                      .evaluation = evaluation,
                                                      .configuration = request_.configuration,
                                                      .net_efficiency = !settings_.median});
    values_.resize(values.size());
    for (std::size_t q = 0; q < values.size(); ++q) values_[q].push_back(values[q]);
    scores_.resize(objectives_.size());
    for (std::size_t o = 0; o < objectives_.size(); ++o) {
      scores_[o].push_back(objectives_[o].score(values));
      if (settings_.median && is_scored(fate) && scores_[o].back() == worst_score) note_undefined(objectives_[o]);
    }
  }

  Assessment result(std::vector<double> interim_scores) {
    if (assessment_.fate != Fate::failed)
      for (std::size_t q = 0; q < values_.size(); ++q)
        assessment_.values.push_back(settings_.median ? together(quantities()[q], values_[q]) : mean_of(values_[q]));
    if (is_scored(assessment_.fate)) {
      for (const std::vector<double>& row : scores_)
        assessment_.scores.push_back(mean_counts() ? mean_of(row) : median_of(row));
      if (settings_.median && trials_ > 1) add_quartiles();
    } else {
      assessment_.scores.assign(objectives_.size(), worst_score);
    }
    assessment_.interim_scores = std::move(interim_scores);
    return std::move(assessment_);
  }

 private:
  static bool is_scored(Fate fate) { return fate == Fate::sound || fate == Fate::stopped; }
  void note_undefined(const Objective& objective) {
    assessment_.fate = worse(assessment_.fate, Fate::undefined);
    assessment_.violation = std::numeric_limits<double>::infinity();
    if (assessment_.problem.empty()) assessment_.problem = objective.undefined_text();
  }
  bool mean_counts() const { return settings_.mean || !settings_.median; }
  double mean_of(const std::vector<double>& row) const {
    return std::accumulate(row.begin(), row.end(), 0.0) / static_cast<double>(trials_);
  }
  void add_quartiles() {
    for (const std::vector<double>& scores : scores_) {
      const Spread spread = settings_.mean ? mean_and_error(scores) : spread_of(scores);
      assessment_.lower_quartiles.push_back(spread.lower_quartile);
      assessment_.upper_quartiles.push_back(spread.upper_quartile);
    }
  }

  const EvaluationRequest& request_;
  const TrialSettings& settings_;
  const std::span<const Objective> objectives_;
  Assessment assessment_{.fate = Fate::sound, .hash = Fnv1a::empty};
  std::vector<std::vector<double>> values_, scores_;  // [quantity or objective][trial]
  std::size_t trials_ = 0;
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
    const RobotSource grown = [&](std::size_t i) {
      return std::make_shared<const Robot>(candidates[i]->grow("candidate"));
    };
    EvaluationRequest request = trial_request(settings_, configuration_, seed_);
    if (std::ranges::any_of(objectives_, uses_folding)) request.folding = measure_all_folding;
    std::vector<std::vector<double>> interim_scores(candidates.size());
    if (settings_.racing && request.steps > static_cast<std::int64_t>(racing_checks)) {
      for (std::size_t check = 1; check <= racing_checks; ++check)
        request.checks.push_back(request.steps * static_cast<std::int64_t>(check) /
                                 static_cast<std::int64_t>(racing_checks + 1));
      request.goes_on = [&](const Evaluation& so_far) {
        std::vector<double>& scores = interim_scores[so_far.index];  // one trial per candidate
        const std::size_t check = scores.size();
        scores.push_back(objectives_.front().score(quantities_of({.robot = *so_far.robot,
                                                                  .evaluation = so_far,
                                                                  .configuration = configuration_,
                                                                  .net_efficiency = !settings_.median})));
        return interim_limits.empty() || scores[check] >= interim_limits[check];
      };
    }
    Evaluator evaluator(request, trial_source(grown, settings_, seed_), all);
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

std::unique_ptr<Assessor> make_local_assessor(const Configuration& configuration, const TrialSettings& trials,
                                              std::vector<Objective> objectives, std::uint64_t seed) {
  return std::make_unique<LocalAssessor>(configuration, trials, std::move(objectives), seed);
}

}  // namespace mercury
