// SPDX-License-Identifier: Apache-2.0
// What a step of the CPU is given besides the robots.
#pragma once

#include <cstddef>
#include <cstdint>

#include "sim/physics/environments.h"
#include "sim/physics/integration.h"

namespace mercury::cpu {

struct StepSetting {
  Solver solver = Solver::force;
  AnyEnvironmentModel model = solver_model_of({.environment = Ocean{}});
  StepConstants constants;
};

// `real_bodies` as in solver_model_of().
inline StepSetting setting_of(const Configuration& configuration, bool real_bodies) {
  return {configuration.solver, solver_model_of(configuration, real_bodies), step_constants(configuration)};
}

// `count` steps from step `first` of the simulation on.
struct StepRange {
  std::int64_t first = 0, count = 0;
};

// L(t) / L0 of all muscles in one step. `count` includes padding.
struct StepFactors {
  const float* first = nullptr;
  std::size_t count = 0;
  bool one_by_one = false;
};
// The same for several steps: [step][muscle]. The factors of each step start at a cache line, and `readable` numbers
// can be read from there.
struct Factors {
  static constexpr std::size_t readable = 256;
  const float* first = nullptr;
  std::size_t muscles = 0;
  bool one_by_one = false;  // Kernel::looks_up_one_by_one
  StepFactors of_step(std::int64_t step) const {
    return {first + static_cast<std::size_t>(step) * muscles, muscles, one_by_one};
  }
};

}  // namespace mercury::cpu
