// The muscle law for all materials of a table, many steps ahead.
#pragma once

#include "sim/cpu/lanes.h"
#include "sim/cpu/muscles.h"

HWY_BEFORE_NAMESPACE();
namespace mercury::cpu::HWY_NAMESPACE {

// Kernel::fill_factors.
inline void fill_factors(Muscles& muscles, float* factors, std::int64_t steps) {
  for (std::size_t id = 0; id < max_materials; id += lane_count) {
    const Lanes amplitude = load_aligned(muscles.amplitude.data() + id);
    Phases phase = load_aligned(muscles.phase.data() + id);
    const Phases per_step = load_aligned(muscles.per_step.data() + id);
    for (std::int64_t step = 0; step < steps; ++step) {
      const Lanes factor = multiply_add(amplitude, sine_of_turns(upper_words(phase)), 1.0f);
      store_aligned(factor, factors + static_cast<std::size_t>(step) * max_materials + id);
      phase = phase + per_step;
    }
    store_aligned(phase, muscles.phase.data() + id);
  }
}

}  // namespace mercury::cpu::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
