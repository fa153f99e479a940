// SPDX-License-Identifier: Apache-2.0
#include "sim/cpu/layout/step_setting.h"

#include <cmath>

namespace mercury::cpu {

StepSetting setting_of(const Configuration& configuration) {
  StepSetting setting;
  setting.solver = configuration.solver;
  setting.model = solver_model_of(configuration.environment);
  setting.contact_stiffness = contact_stiffness_of(configuration.environment, configuration.solver, configuration.dt);
  setting.constants = {static_cast<float>(configuration.dt), static_cast<float>(1 / configuration.dt),
                       static_cast<float>(std::exp(-configuration.damping * configuration.dt))};
  return setting;
}

}  // namespace mercury::cpu
