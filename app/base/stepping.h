// SPDX-License-Identifier: Apache-2.0
// Stepping a simulation so that the user can stop it.
#pragma once

#include <chrono>
#include <cstdint>

#include "mercury/simulation.h"

namespace mercury {

// Advances in calls of about a tenth of a second, whatever a step costs, and looks for Ctrl-C in between. The results
// do not depend on how the steps are split.
class Stepper {
 public:
  explicit Stepper(Simulation& simulation) : simulation_(simulation) {}

  // Steps until the simulation has done `target` steps. False if the user asked to stop before.
  bool advance_to(std::int64_t target);

  // Time spent in stepping [s].
  double wall_seconds() const { return wall_seconds_; }

 private:
  Simulation& simulation_;
  std::int64_t call_ = 1;  // steps in the next call
  double wall_seconds_ = 0;
};

}  // namespace mercury
