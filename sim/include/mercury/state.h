// SPDX-License-Identifier: Apache-2.0
// The state of one robot at an instant.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "mercury/brain.h"
#include "mercury/clock.h"
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
  BrainState brain;                          // of its brain; empty = it has none, or it is not known
};

// All that the steps of a batch change: with the same robots, configuration, materials, perturbations and actuation, a
// simulation goes on from here bit for bit, on the same kind of device.
struct BatchState {
  struct Explosion {
    std::size_t robot = 0;
    std::int64_t step = 0;  // that failed
    double at = 0;          // when that step began [s]
    std::uint32_t culprit_spring = no_spring;
  };
  Clock clock;
  std::vector<Vec3> positions, velocities;  // one per mass of all robots, robot after robot [m], [m/s]
  std::vector<Explosion> explosions;        // of the robots that have exploded, by index
  std::vector<BrainState> brains;           // one per robot; empty = all as at the start
};

}  // namespace mercury
