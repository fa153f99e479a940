// SPDX-License-Identifier: Apache-2.0
// Tries robots and scores them.
#pragma once

#include <cstddef>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "mercury/configuration.h"
#include "mercury/individual.h"
#include "mercury/objective.h"
#include "mercury/trials.h"

namespace mercury {

// Racing looks at the scores after equal parts of the trial, at as many checks.
inline constexpr std::size_t racing_checks = 3;

// What becomes known while robots are tried. `done` of `all` trials; returns whether to go on.
using Watch = std::function<bool(std::size_t done, std::size_t all)>;

class Assessor {
 public:
  virtual ~Assessor() = default;

  // One assessment per candidate, in their order. `interim_limits` has a score per check of racing (may be empty): a
  // candidate that scores less at that check is stopped. Returns nothing if `watch` said to stop. Results depend on
  // candidates and limits alone: not on threads, devices, portions, nor on the other candidates. Throws DeviceError.
  virtual std::optional<std::vector<Assessment>> assess(std::span<const GenomePointer> candidates,
                                                        std::span<const double> interim_limits, const Watch& watch) = 0;
  // Candidates of the next call of assess(), or of the one after those that were prepared before. An assessor may begin
  // to try them; what assess() returns is the same.
  virtual void prepare(std::span<const GenomePointer> /*candidates*/, std::span<const double> /*interim_limits*/) {}
  // For people; empty before the first call of assess().
  virtual std::string device_name() const = 0;
  // For how long its devices have stepped robots, mean over them [s]; 0 if that is not known.
  virtual double busy_seconds() const { return 0; }
};

// On the devices of this process (configuration.device). Scores of custom objectives are 0; who computes them finds
// what the trials gave in Assessment::trial_values.
std::unique_ptr<Assessor> make_local_assessor(const Configuration& configuration, const TrialSettings& trials,
                                              std::vector<Objective> objectives, std::uint64_t seed);

}  // namespace mercury
