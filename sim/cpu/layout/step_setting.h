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
  AnyEnvironmentModel model = solver_model_of(Ocean{});
  StepConstants constants;
};

// `real_bodies` as in solver_model_of().
inline StepSetting setting_of(const Configuration& configuration, bool real_bodies) {
  return {configuration.solver, solver_model_of(configuration.environment, real_bodies), step_constants(configuration)};
}

// `count` steps from step `first` of the simulation on.
struct StepRange {
  std::int64_t first = 0, count = 0;
};

// L(t) / L0 of all muscles, for several steps: [step][muscle].
struct Factors {
  const float* first = nullptr;
  std::size_t muscles = 0;
  const float* of_step(std::int64_t step) const { return first + static_cast<std::size_t>(step) * muscles; }
};

}  // namespace mercury::cpu
