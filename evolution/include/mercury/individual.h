// SPDX-License-Identifier: Apache-2.0
// One robot of an evolution: where it comes from and how it did.
#pragma once

#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "mercury/genome.h"

namespace mercury {

inline constexpr double worst_score = -std::numeric_limits<double>::infinity();

// How the trials of an individual ended: as the worst of them. Only `sound` individuals have scores above the worst;
// those `stopped` early by racing have the score that they had when they were stopped. `undefined`: an objective is not
// a finite number. Files have the numbers.
enum class Fate : std::uint8_t { sound, stopped, exploded, overstretched, failed, too_small, undefined };
inline constexpr Fate last_fate = Fate::undefined;
std::string_view name_of(Fate fate);  // "sound", ...
std::optional<Fate> fate_named(std::string_view name);
Fate worse(Fate a, Fate b);

// What the trials of one individual gave.
struct Assessment {
  Fate fate = Fate::failed;
  std::string problem;  // why it failed: its robot could not be grown or breaks a rule; why its score is undefined
  std::vector<double> scores;          // per objective, of all trials together; worst_score unless sound or stopped
  std::vector<double> values;          // per quantity (quantity.h), of all trials together; empty if it failed
  std::vector<double> interim_scores;  // of the first objective at the checks of racing that it passed or lost
  std::uint64_t hash = 0;              // of the final states of all trials
  // Of the trials' scores, per objective; empty where a score is the mean of trials, or the worst.
  std::vector<double> lower_quartiles, upper_quartiles;
  double violation = 0;  // the largest violation_of() a trial (trials.h): how far it is from being sound
  // Per trial and quantity; only while a custom objective (custom.h) is to be computed from them.
  std::vector<std::vector<double>> trial_values;
  friend bool operator==(const Assessment&, const Assessment&) = default;
};

struct Individual {
  std::uint64_t id = 0;                // in the order of birth, from 0
  std::vector<std::uint64_t> parents;  // ids; none = drawn at random, or given by the user; two after a crossover
  int generation = 0;                  // in which it was born
  int line_began = 0;                  // generation in which its oldest ancestor was drawn (the age of AFPO)
  std::uint64_t seed = 0;              // of its mutation and crossover, or of the random genome; 0 = of a migrant
  std::uint16_t island = 0;            // on which it was born
  bool is_migrant = false;             // a copy of its one parent, which is of another island
  GenomePointer genome;
  Assessment assessment;

  // The only or first score; worst_score before it was assessed.
  double score() const { return assessment.scores.empty() ? worst_score : assessment.scores.front(); }
};

}  // namespace mercury
