// SPDX-License-Identifier: Apache-2.0
// When a robot explodes during a launch. Its warps share one Failure in shared memory; the earliest one counts.
#pragma once

#include <cstdint>

namespace mercury::cuda {

// The phases of a step. A phase is skipped if the robot failed in an earlier one, or in an earlier step.
enum Phase : std::uint32_t { phase_environment = 0, phase_prediction = 1, phase_springs = 2, phase_end = 3 };

struct Failure {
  static constexpr std::uint32_t never = 0xffffffffu;

  std::uint32_t when;      // 1 + 4 step + phase; 0 = before the launch; or never
  std::uint32_t bad_mass;  // the lowest one, or never

  __device__ bool before(std::uint32_t step, Phase phase) const {
    return *static_cast<const volatile std::uint32_t*>(&when) <= 4 * step + phase;
  }
  __device__ void report(std::uint32_t step, Phase phase, std::uint32_t mass) {
    atomicMin(&when, 1 + 4 * step + phase);
    atomicMin(&bad_mass, mass);
  }
  __device__ bool happened() const { return when != never; }
  __device__ std::uint32_t step() const { return (when - 1) / 4; }
};

}  // namespace mercury::cuda
