// SPDX-License-Identifier: Apache-2.0
// The state of one robot at an instant.
#pragma once

#include <cstdint>
#include <vector>

#include "mercury/robot.h"
#include "mercury/vec3.h"

namespace mercury {

// A copy: it does not change when the simulation goes on.
struct State {
  std::vector<Vec3> positions;   // one per mass [m]
  std::vector<Vec3> velocities;  // one per mass [m/s]
  // A robot explodes when a position, a spring's length or a face's force leaves the range that a step accepts
  // (docs/physics.md). It is then frozen in the step that failed.
  bool exploded = false;
  double exploded_at = 0;                    // when that step began [s], if exploded
  std::uint32_t culprit_spring = no_spring;  // index in Robot::springs, if exploded and a spring is known as the cause
};

}  // namespace mercury
