// One robot's steps on the CPU, for every pair of solver and environment.
#pragma once

#include <variant>

#include "sim/cpu/body.h"
#include "sim/environments.h"
#include "sim/integration.h"

namespace mercury::cpu {

struct ContactLaw {
  float stiffness = 0;  // k_c times the stiffness scale [N/m]; 0 = no self-collision
};

using AnyHooks = std::variant<OceanHooks, OceanSimpleHooks, LandHooks>;

struct StepSetting {
  Solver solver = Solver::force;
  AnyHooks hooks = OceanHooks(Ocean{});
  ContactLaw contact;
  StepConstants constants;
};

StepSetting setting_of(const Configuration& configuration);

// Advances a body that has not exploded; stops where it explodes.
void advance(Body& body, const StepSetting& setting, const Clock& clock, std::int64_t steps);

}  // namespace mercury::cpu
