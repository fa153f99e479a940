// SPDX-License-Identifier: Apache-2.0
#include "app/base/stepping.h"

#include <algorithm>

#include "app/base/interrupt.h"

namespace mercury {

bool Stepper::advance_to(std::int64_t target) {
  constexpr double longest_call = 0.1;  // [s]
  while (simulation_.steps() < target) {
    if (interrupted()) return false;
    const std::int64_t count = std::min(call_, target - simulation_.steps());
    const auto start = std::chrono::steady_clock::now();
    simulation_.step(count);
    const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    wall_seconds_ += seconds;
    if (seconds > longest_call)
      call_ = std::max<std::int64_t>(1, count / 2);
    else if (count == call_ && seconds < longest_call / 4)
      call_ *= 2;
  }
  return true;
}

}  // namespace mercury
