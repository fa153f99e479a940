// SPDX-License-Identifier: Apache-2.0
// Steps a simulation so that the user can interrupt it.
#pragma once

#include <cstdint>

#include "mercury/simulation.h"

namespace mercury {

// Splits the steps into calls of about a tenth of a second and checks for Ctrl-C between them. The results do not
// depend on how the steps are split.
class Stepper {
 public:
  explicit Stepper(Simulation& simulation) : simulation_(simulation) {}

  // Steps until the simulation has made `target` steps in all. Returns false if the user interrupted it.
  bool advance_to(std::int64_t target);

  // Wall time spent in steps [s].
  double wall_seconds() const { return wall_seconds_; }

 private:
  Simulation& simulation_;
  std::int64_t steps_per_call_ = 1;  // adapted to the speed
  double wall_seconds_ = 0;
};

}  // namespace mercury
