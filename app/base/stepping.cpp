// SPDX-License-Identifier: Apache-2.0
#include "app/base/stepping.h"

#include <algorithm>

#include "app/base/interrupt.h"
#include "mercury/stopwatch.h"

namespace mercury {

bool Stepper::advance_to(std::int64_t target) {
  constexpr double target_duration = 0.1;  // of one call of step() [s]
  while (simulation_.steps() < target) {
    if (interrupted()) return false;
    const std::int64_t count = std::min(steps_per_call_, target - simulation_.steps());
    const double start = wall_now();
    simulation_.step(count);
    const double seconds = wall_now() - start;
    wall_seconds_ += seconds;
    if (seconds > target_duration)
      steps_per_call_ = std::max<std::int64_t>(1, count / 2);
    else if (count == steps_per_call_ && seconds < target_duration / 4)
      steps_per_call_ *= 2;
  }
  return true;
}

}  // namespace mercury
