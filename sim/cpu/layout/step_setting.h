// SPDX-License-Identifier: Apache-2.0
// What a step of the CPU is given besides the robots.
#pragma once

#include <cmath>

#include "sim/physics/environments.h"
#include "sim/physics/integration.h"

namespace mercury::cpu {

struct StepSetting {
  Solver solver = Solver::force;
  AnyEnvironmentModel model = solver_model_of(Ocean{});
  float contact_stiffness = 0;  // k_c times the stiffness scale [N/m]; 0 = no contacts
  StepConstants constants;
};

inline StepSetting setting_of(const Configuration& configuration) {
  StepSetting setting;
  setting.solver = configuration.solver;
  setting.model = solver_model_of(configuration.environment);
  setting.contact_stiffness = contact_stiffness_of(configuration.environment, configuration.solver, configuration.dt);
  setting.constants = {static_cast<float>(configuration.dt), static_cast<float>(1 / configuration.dt),
                       static_cast<float>(std::exp(-configuration.damping * configuration.dt))};
  return setting;
}

// L(t) / L0 of all muscles, for several steps: [step][muscle].
struct Factors {
  const float* first = nullptr;
  std::size_t muscles = 0;
  const float* of_step(std::int64_t step) const { return first + static_cast<std::size_t>(step) * muscles; }
};

}  // namespace mercury::cpu
