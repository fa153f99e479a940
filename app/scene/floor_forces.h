// SPDX-License-Identifier: Apache-2.0
// What the ground does to robots that stand on it, for the eye.
#pragma once

#include <vector>

#include "app/scene/coloring.h"
#include "mercury/simulation.h"

namespace mercury {

struct FloorForce {
  std::uint32_t mass = 0;  // of the robot
  Vec3 force;              // [N]
};

// The floor's push and friction on each mass of a robot that lies on it, as the next step will have them if nothing
// else touches the mass: what holds it against its springs, gravity and its own momentum, friction at most its
// coefficient times the push. Empty where there is no floor.
std::vector<FloorForce> floor_forces(const Simulation& simulation, std::size_t robot, const GroupState& state);

}  // namespace mercury
