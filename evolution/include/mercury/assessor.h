// SPDX-License-Identifier: Apache-2.0
// Tries robots and scores them.
#pragma once

#include <cstddef>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <tuple>
#include <vector>

#include "mercury/configuration.h"
#include "mercury/evaluator.h"
#include "mercury/individual.h"
#include "mercury/objective.h"
#include "mercury/parameters.h"

namespace mercury {

// The trials of every individual.
struct TrialSettings {
  double seconds = 10;      // of a trial, settling included [s]
  double settle = 0;        // at its start; nothing is measured before [s]
  int trials = 1;           // per individual
  double noise = 0;         // standard deviation by which the trials' stiffnesses and amplitudes differ [1]
  double damage = 0;        // share of the voxels that a trial's robot lacks [1]
  double strain_limit = 2;  // robots with a spring that was strained more get the worst score
  bool racing = false;      // stop robots that are clearly behind
  friend bool operator==(const TrialSettings&, const TrialSettings&) = default;

  static constexpr std::tuple parameters{
      Parameter("seconds", &TrialSettings::seconds, "s", Accepts::at_least_zero, {1, 60},
                "Length of a trial, settling included"),
      Parameter("settle", &TrialSettings::settle, "s", Accepts::at_least_zero, {0, 10},
                "Measure from this time on, after robots have fallen"),
      Parameter("trials", &TrialSettings::trials, "", Accepts::between(1, 1000), {1, 20},
                "Trials per robot, started at different moments of its movement"),
      Parameter("noise", &TrialSettings::noise, "", Accepts::at_least_zero, {0, 0.5f},
                "Standard deviation of stiffness and amplitude between trials")
          .with_form("0..1"),
      Parameter("damage", &TrialSettings::damage, "", Accepts::share_below_one(), {0, 0.5f},
                "Share of the voxels that are missing in a trial")
          .with_form("0..1"),
      Parameter("strain_limit", &TrialSettings::strain_limit, "",
                Accepts{.lowest = 0, .above_lowest = true, .or_infinite = true}, {0.1f, 4},
                "Robots with a spring strained more are overstretched: they rank after all sound ones")
          .with_default_note("default 2; inf = no limit"),
      Parameter("racing", &TrialSettings::racing, "Stop robots early that are clearly behind")};
};

// Throws ParameterError for settings out of range. A trial of 0 s is accepted.
void validate(const TrialSettings& settings);

// Between two samples of a trial. Paths, work and strains depend on it [s].
inline constexpr double trial_sample_period = 0.05;

// What an Evaluator does for a trial of one robot: it settles, is stepped and sampled.
EvaluationRequest trial_request(const TrialSettings& settings, const Configuration& configuration);

// How that trial ended: `evaluation` is its result.
Fate fate_of(const Evaluation& evaluation, const EvaluationRequest& request, double strain_limit);

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
  // For people; empty before the first call of assess().
  virtual std::string device_name() const = 0;
};

// On the devices of this process (configuration.device).
std::unique_ptr<Assessor> make_local_assessor(const Configuration& configuration, const TrialSettings& trials,
                                              std::vector<Objective> objectives, std::uint64_t seed);

}  // namespace mercury
