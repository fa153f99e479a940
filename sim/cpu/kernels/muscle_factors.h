// SPDX-License-Identifier: Apache-2.0
// The muscle law for all muscles, several steps at once.
#pragma once

#include "sim/cpu/kernels/lanes.h"
#include "sim/cpu/layout/muscles.h"

HWY_BEFORE_NAMESPACE();
namespace mercury::cpu::HWY_NAMESPACE {

// Kernel::fill_factors.
inline void fill_factors(Muscles& muscles, float* factors, std::int64_t steps) {
  const std::size_t size = muscles.amplitude.size();
  for (std::size_t id = 0; id < size; id += lane_count) {
    const Lanes amplitude = load_aligned(muscles.amplitude.data() + id);
    const Lanes highest = load_aligned(muscles.highest.data() + id);
    Phases phase = load_aligned(muscles.phase.data() + id);
    const Phases per_step = load_aligned(muscles.per_step.data() + id);
    for (std::int64_t step = 0; step < steps; ++step) {
      const Lanes factor = length_factor(amplitude, sine_of_turns(upper_words(phase)), highest);
      store_aligned(factor, factors + static_cast<std::size_t>(step) * size + id);
      phase = phase + per_step;
    }
    store_aligned(phase, muscles.phase.data() + id);
  }
  muscles.step += steps;
}

}  // namespace mercury::cpu::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
