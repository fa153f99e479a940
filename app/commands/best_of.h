// SPDX-License-Identifier: Apache-2.0
// A search among random robots: simulates each and keeps those that move farthest.
#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <vector>

#include "app/base/interrupt.h"
#include "app/commands/robot_results.h"
#include "app/options/robot_output.h"
#include "mercury/assessor.h"
#include "mercury/configuration.h"
#include "mercury/robot.h"

namespace mercury {

struct Contest {
  std::string kind;              // of the robots' generator
  std::uint64_t seed = 1;        // of the robots
  std::uint64_t candidates = 0;  // number of robots to try, from index 0 on
  Configuration configuration;   // of the trials
  TrialSettings trials;          // what counts
  // Receives the result of each candidate, by index. Optional.
  std::function<void(const RobotResult&)> watch;
};

struct Winner {
  std::shared_ptr<const Robot> robot;
  RobotResult result;
};

struct ContestResult {
  std::vector<Winner> winners;          // the best first; equal ones are ordered by index
  std::map<Fate, std::uint64_t> fates;  // how many candidates ended how
  bool interrupted = false;             // by the user: candidates are missing, or were stopped
  std::uint64_t tried() const;          // candidates whose trial is complete
};

// Keeps the `count` robots that move farthest. Only sound ones count, so none that cannot be made, explodes or is
// strained beyond the limit. If the user interrupts, these are the best of those that were tried. The result does not
// depend on how many robots are simulated at once. `results` begin with the first step.
ContestResult best_of(const Contest& contest, const MakeRobot& make, std::uint64_t count, UnsavedResults& results);

}  // namespace mercury
