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
  const auto show = [&] {
    const EvaluationProgress now = evaluator.progress();
    if (now.robot_steps > 0) results.begin();
    progress.update({static_cast<std::int64_t>(now.done),
                     static_cast<double>(now.robot_steps) / static_cast<double>(std::max<std::int64_t>(1, steps))});
  };
  bool stopped = false;
  for (std::uint64_t turn = 0;; ++turn) {
    if (!stopped && interrupted()) {
      stopped = true;
      evaluator.stop();
    }
    const bool is_ready = evaluator.wait_for(period);
    if (!is_ready || turn % 1024 == 0) show();
    if (!is_ready) continue;
    const std::optional<Evaluation> result = evaluator.next();
    if (!result) {
      show();
      return !stopped;
    }
    take(*result);
  }
}

}  // namespace mercury
