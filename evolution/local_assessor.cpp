// SPDX-License-Identifier: Apache-2.0
// Tries candidates on the devices of this process, by one Evaluator: it grows them while others are stepped, and its
// devices stay ready from one generation to the next.
#include <algorithm>
#include <chrono>
#include <deque>
#include <functional>
#include <limits>
#include <memory>
#include <mutex>
#include <numeric>
#include <utility>

#include "mercury/assessor.h"
#include "mercury/evaluator.h"
#include "mercury/fnv.h"
#include "mercury/parallel.h"
#include "mercury/quantity.h"
#include "mercury/spread.h"
#include "mercury/trials.h"

namespace mercury {
namespace {

constexpr std::chrono::milliseconds watch_period(100);
constexpr std::size_t most_waiting = 512;  // evaluations

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
    const bool is_same_robot = evaluation.robot == robot_;
    const std::vector<double> values =
        quantities_of({.robot = *evaluation.robot,
                       .evaluation = evaluation,
                       .configuration = request_.configuration,
                       .net_efficiency = !settings_.median},
                      is_same_robot ? std::span<const double>(last_values_) : std::span<const double>());
    robot_ = evaluation.robot;
    last_values_ = values;
    values_.resize(values.size());
    for (std::size_t q = 0; q < values.size(); ++q) values_[q].push_back(values[q]);
    scores_.resize(objectives_.size());
    if (std::ranges::any_of(objectives_, &Objective::is_custom)) assessment_.trial_values.push_back(values);
    for (std::size_t o = 0; o < objectives_.size(); ++o) {
      scores_[o].push_back(objectives_[o].is_custom() ? 0 : objectives_[o].score(values));
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
  std::shared_ptr<const Robot> robot_;  // of the last trial
  std::vector<double> last_values_;     // of its quantities
};

// Candidates that are assessed together: a part of what the evaluator's source has.
struct Batch {
  std::vector<GenomePointer> candidates;
  std::vector<double> interim_limits;
  std::size_t first = 0;                            // index of the first evaluation
  std::vector<std::vector<double>> interim_scores;  // [candidate][check so far]; one trial per candidate
};

// Batches in their order. Threads of the evaluator ask for them.
class Batches {
 public:
  void add(std::shared_ptr<Batch> batch) {
    const std::lock_guard lock(mutex_);
    batches_.push_back(std::move(batch));
  }
  std::shared_ptr<Batch> front() const {
    const std::lock_guard lock(mutex_);
    return batches_.empty() ? nullptr : batches_.front();
  }
  void pop() {
    const std::lock_guard lock(mutex_);
    batches_.pop_front();
  }
  // The one that an evaluation belongs to.
  std::shared_ptr<Batch> of(std::size_t evaluation) const {
    const std::lock_guard lock(mutex_);
    auto found = batches_.end();
    while ((*--found)->first > evaluation) {
    }
    return *found;
  }

 private:
  mutable std::mutex mutex_;
  std::deque<std::shared_ptr<Batch>> batches_;
};

class LocalAssessor : public Assessor {
 public:
  LocalAssessor(const Configuration& configuration, const TrialSettings& settings, std::vector<Objective> objectives,
                std::uint64_t seed)
      : settings_(settings), objectives_(std::move(objectives)), seed_(seed),
        request_(trial_request(settings, configuration, seed)) {
    request_.grows = true;
    request_.notes = false;
    if (std::ranges::any_of(objectives_, uses_folding)) request_.folding = measure_all_folding;
    request_.upright = request_.upright || std::ranges::any_of(objectives_, uses_upright);
    if (!settings_.racing || request_.steps <= static_cast<std::int64_t>(racing_checks)) return;
    for (std::size_t check = 1; check <= racing_checks; ++check)
      request_.checks.push_back(request_.steps * static_cast<std::int64_t>(check) /
                                static_cast<std::int64_t>(racing_checks + 1));
    request_.goes_on = [this](const Evaluation& so_far) { return goes_on(so_far); };
  }

  void prepare(std::span<const GenomePointer> candidates, std::span<const double> interim_limits) override {
    if (!evaluator_) evaluator_ = std::make_unique<Evaluator>(request_, trial_source(source(), settings_, seed_), 0);
    const std::size_t evaluations = candidates.size() * trials();
    auto batch = std::make_shared<Batch>();
    batch->candidates.assign(candidates.begin(), candidates.end());
    batch->interim_limits.assign(interim_limits.begin(), interim_limits.end());
    batch->first = known_;
    batch->interim_scores.resize(candidates.size());
    batches_.add(std::move(batch));
    known_ += evaluations;
    evaluator_->extend(evaluations);
  }

  std::optional<std::vector<Assessment>> assess(std::span<const GenomePointer> candidates,
                                                std::span<const double> interim_limits, const Watch& watch) override {
    if (const auto next = batches_.front(); next && !std::ranges::equal(next->candidates, candidates)) forget();
    if (!batches_.front()) prepare(candidates, interim_limits);
    try {
      std::optional<std::vector<Assessment>> assessments = finish(*batches_.front(), watch);
      if (assessments)
        batches_.pop();
      else
        forget();
      return assessments;
    } catch (...) {
      forget();
      throw;
    }
  }

  std::string device_name() const override { return device_name_; }

  double busy_seconds() const override {
    if (!evaluator_) return 0;
    const std::vector<EvaluationProgress::Device> devices = evaluator_->progress().devices;
    return std::transform_reduce(devices.begin(), devices.end(), 0.0, std::plus(),
                                 [](const auto& device) { return device.busy_seconds; }) /
           static_cast<double>(devices.size());
  }

 private:
  std::size_t trials() const { return static_cast<std::size_t>(settings_.trials); }

  RobotSource source() const {
    return [this](std::size_t i) {
      const std::shared_ptr<Batch> batch = batches_.of(i * trials());
      return std::make_shared<const Robot>(batch->candidates[i - batch->first / trials()]->grow_for_trial("candidate"));
    };
  }

  bool goes_on(const Evaluation& so_far) const {
    const std::shared_ptr<Batch> batch = batches_.of(so_far.index);
    std::vector<double>& scores = batch->interim_scores[so_far.index - batch->first];
    const std::size_t check = scores.size();
    scores.push_back(objectives_.front().score(quantities_of({.robot = *so_far.robot,
                                                              .evaluation = so_far,
                                                              .configuration = request_.configuration,
                                                              .net_efficiency = !settings_.median})));
    return batch->interim_limits.empty() || scores[check] >= batch->interim_limits[check];
  }

  // Cancels all that was begun.
  void forget() {
    evaluator_.reset();
    while (batches_.front()) batches_.pop();
    known_ = 0;
  }

  std::optional<std::vector<Assessment>> finish(Batch& batch, const Watch& watch) {
    const std::size_t all = batch.candidates.size() * trials();
    const auto done = [&] {
      const std::size_t evaluated = evaluator_->progress().done;  // of later batches, too
      return std::min(all, evaluated - std::min(evaluated, batch.first));
    };
    std::vector<Assessment> assessments(batch.candidates.size());
    std::vector<Evaluation> waiting;  // of whole candidates; their quantities are computed on all cores
    std::size_t assessed = 0;
    const auto assess_waiting = [&] {
      parallel_for(0, waiting.size() / trials(), [&](std::size_t k) {
        Tally tally(request_, settings_, objectives_);
        for (std::size_t t = 0; t < trials(); ++t) tally.add(waiting[k * trials() + t]);
        assessments[assessed + k] = tally.result(std::move(batch.interim_scores[assessed + k]));
        // To free 512 robots one after another takes as long as to assess them on all cores.
        for (std::size_t t = 0; t < trials(); ++t) waiting[k * trials() + t] = {};
      });
      assessed += waiting.size() / trials();
      waiting.clear();
    };
    for (std::size_t i = 0; i < batch.candidates.size(); ++i) {
      for (std::size_t t = 0; t < trials(); ++t) {
        while (!evaluator_->wait_for(watch_period))
          if (watch && !watch(done(), all)) return std::nullopt;
        waiting.push_back(evaluator_->next().value());
      }
      if (waiting.size() < most_waiting) continue;
      assess_waiting();
      if (watch && !watch(done(), all)) return std::nullopt;
    }
    assess_waiting();
    if (watch && !watch(all, all)) return std::nullopt;
    if (device_name_.empty()) device_name_ = evaluator_->device_name();
    return assessments;
  }

  const TrialSettings settings_;
  const std::vector<Objective> objectives_;
  const std::uint64_t seed_;
  EvaluationRequest request_;
  Batches batches_;
  std::size_t known_ = 0;  // evaluations that the evaluator knows of
  std::string device_name_;
  std::unique_ptr<Evaluator> evaluator_;  // last: its threads use the others
};

}  // namespace

std::unique_ptr<Assessor> make_local_assessor(const Configuration& configuration, const TrialSettings& trials,
                                              std::vector<Objective> objectives, std::uint64_t seed) {
  return std::make_unique<LocalAssessor>(configuration, trials, std::move(objectives), seed);
}

}  // namespace mercury
