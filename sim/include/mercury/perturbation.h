// SPDX-License-Identifier: Apache-2.0
// A force that a user applies to a mass while the simulation runs.
#pragma once

#include <cstddef>
#include <cstdint>

#include "mercury/vec3.h"

namespace mercury {

// Pulls one mass toward a point by a spring of rest length 0: F = stiffness (target - x). The window pulls robots with
// the mouse this way.
struct Perturbation {
  std::size_t robot = 0;   // index in the simulation
  std::uint16_t mass = 0;  // index in Robot::masses
  Vec3 target;             // in the robot's own coordinates [m]
  float stiffness = 50;    // [N/m]
};

}  // namespace mercury
