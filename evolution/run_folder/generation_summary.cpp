// SPDX-License-Identifier: Apache-2.0
#include "evolution/run_folder/generation_summary.h"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

namespace mercury {
namespace {

// The quantile between the two nearest of sorted values (Hyndman and Fan's definition 7, as NumPy's default).
double quantile(std::span<const double> sorted, double share) {
  const double position = share * static_cast<double>(sorted.size() - 1);
  const auto below = static_cast<std::size_t>(position);
  const double rest = position - static_cast<double>(below);
  if (rest == 0) return sorted[below];
  if (std::isinf(sorted[below])) return sorted[below];
  return sorted[below] + rest * (sorted[below + 1] - sorted[below]);
}

ScoreSpread spread_of(std::span<const std::uint64_t> living, std::span<const Individual> individuals,
                      std::size_t objective) {
  std::vector<double> scores;
  for (const std::uint64_t id : living) {
    const std::vector<double>& all = individuals[id].assessment.scores;
    scores.push_back(all.empty() ? worst_score : all[objective]);
  }
  if (scores.empty()) return {};
  std::ranges::sort(scores);
  return {quantile(scores, 0.25), quantile(scores, 0.5), quantile(scores, 0.75), scores.back()};
}

}  // namespace

GenerationSummary summary_of(int number, GenerationTimes times, std::span<const Individual> born,
                             std::span<const std::uint64_t> living, std::span<const Individual> individuals,
                             std::size_t objectives) {
  GenerationSummary summary{.number = number, .born = born.size(), .living = living.size()};
  for (const Individual& individual : born) {
    const Fate fate = individual.assessment.fate;
    summary.exploded += fate == Fate::exploded;
    summary.overstretched += fate == Fate::overstretched;
    summary.stopped += fate == Fate::stopped;
    summary.failed += fate == Fate::failed;
  }
  if (!living.empty()) {
    summary.best = living.front();
    summary.best_scores = individuals[living.front()].assessment.scores;
  }
  for (std::size_t i = 0; i < objectives; ++i) summary.scores.push_back(spread_of(living, individuals, i));
  summary.median_score = summary.scores.empty() ? worst_score : summary.scores.front().median;
  summary.times = std::move(times);
  return summary;
}

}  // namespace mercury
