// SPDX-License-Identifier: Apache-2.0
// What a block of threads shares while it steps its robots.
#pragma once

#include "sim/cuda/step.h"

namespace mercury::cuda {

// When in a step something went wrong: at 4 step + phase. A phase is carried out unless the robot failed before it.
enum Phase : std::uint32_t { phase_environment = 0, phase_prediction = 1, phase_springs = 2, phase_end = 3 };
inline constexpr std::uint32_t never = 0xffffffffu;

struct Failure {
  std::uint32_t when;
  std::uint32_t bad_mass;
};

}  // namespace mercury::cuda
