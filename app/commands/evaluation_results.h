// SPDX-License-Identifier: Apache-2.0
// The results of an evaluator with a progress bar, until the user interrupts.
#pragma once

#include <algorithm>
#include <chrono>
#include <cstdint>
#include <optional>

#include "app/base/interrupt.h"
#include "app/base/progress.h"
#include "mercury/evaluator.h"

namespace mercury {

// Calls take(evaluation) for each result. After an interrupt, these are what Evaluator::stop() leaves, and it returns
// false. `steps` = of each robot, settling included. `results` begin with the first step.
template <class Take>
bool take_results(Evaluator& evaluator, Progress& progress, std::int64_t steps, UnsavedResults& results,
                  const Take& take) {
  constexpr std::chrono::milliseconds period{100};
  bool stopped = false;
  for (std::uint64_t turn = 0;; ++turn) {
    if (!stopped && interrupted()) {
      stopped = true;
      evaluator.stop();
    }
    const bool is_ready = evaluator.wait_for(period);
    if (!is_ready || turn % 1024 == 0) {
      const std::int64_t made = evaluator.progress().robot_steps;
      if (made > 0) results.begin();
      progress.update_with_fraction(static_cast<double>(made) / static_cast<double>(std::max<std::int64_t>(1, steps)));
    }
    if (!is_ready) continue;
    const std::optional<Evaluation> result = evaluator.next();
    if (!result) return !stopped;
    take(*result);
  }
}

}  // namespace mercury
