// SPDX-License-Identifier: Apache-2.0
// Materials at a moment.
#pragma once

#include <vector>

#include "mercury/simulation.h"

namespace mercury {

struct MaterialNow {
  float stiffness;      // times the environment's scale [N/m]
  float length_factor;  // 1 + dL0 sin(omega t + phi)
};

// One a material of the robot's table, as it is in the simulation.
std::vector<MaterialNow> materials_at(const Simulation& simulation, std::size_t robot, double time);

}  // namespace mercury
