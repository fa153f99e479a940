// SPDX-License-Identifier: Apache-2.0
// Whether a result holds: a robot is tried again at the time step, at half and at a quarter of it, each time with
// several jitters, and gets one verdict.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "mercury/configuration.h"
#include "mercury/evaluator.h"
#include "mercury/objective.h"
#include "mercury/spread.h"
#include "mercury/trials.h"

namespace mercury {

// The first that applies, in this order.
enum class Verdict : std::uint8_t {
  failed,         // it could not be stepped
  unsound,        // at the time step itself, a trial exploded or broke a limit
  chaotic,        // at one of the time steps, the quartiles are far apart
  depends_on_dt,  // a trial at a smaller step is not sound, or the median at a quarter of the step is another one
  transient,      // the speed does not last, as far as the score is one of travel
  confirmed
};
std::string_view name_of(Verdict verdict);  // "depends on dt", ...
std::optional<Verdict> verdict_named(std::string_view name);

// What is too far apart, as shares of a median.
inline constexpr double most_between_quartiles = 0.2, most_change_with_dt = 0.1;
// Distances that differ by less than this share of the body's length are the same.
inline constexpr double same_place = 0.01;

// At dt, dt/2 and dt/4.
inline constexpr std::size_t checked_steps = 3;
inline constexpr int check_trials = 5;  // at each

// The usual trials of a check.
constexpr TrialSettings check_settings() {
  TrialSettings settings = search_trials();
  settings.trials = check_trials;
  return settings;
}

// What the trials at one time step gave.
struct CheckedStep {
  double dt = 0;  // [s]
  Fate fate = Fate::failed;
  Spread score;             // NaN unless the fate is sound; mean and standard error if the mean counts
  double steady_share = 0;  // of the trials that were steady
  friend bool operator==(const CheckedStep&, const CheckedStep&) = default;
};

struct Confirmation {
  std::string robot;  // its name; empty if it could not be made
  Verdict verdict = Verdict::failed;
  std::string reason;  // one line with numbers; empty if it is confirmed
  std::array<CheckedStep, checked_steps> steps;
  friend bool operator==(const Confirmation&, const Confirmation&) = default;
};

// Fills in verdict and reason. `same` = scores that differ by less are the same; `travels` = whether the score grows
// with how far the robot gets; `of_means` = the scores are means of different trials, whose spread is no chaos.
void judge(Confirmation& confirmation, double same, bool travels, bool of_means = false);

// One per robot, in their order. The robots may be random ones that cannot be made. `seed` = of the jitter. Returns
// nothing if `watch`, which is called with the trials that are done, said to stop. Throws DeviceError.
std::optional<std::vector<Confirmation>> check_robots(
    const RobotSource& robots, std::size_t count, const Configuration& configuration, const TrialSettings& trials,
    const Objective& objective, std::uint64_t seed, const std::function<bool(std::size_t done, std::size_t all)>& watch,
    std::string* device_name = nullptr);

}  // namespace mercury
